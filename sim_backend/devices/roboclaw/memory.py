"""What a RoboClaw keeps and tells: its settings, with the defaults of its manual, and its status flags (command 90)."""

from dataclasses import dataclass, field
from enum import IntFlag

from sim_backend.faults.script import OverTemperature, SupplyLost, Trip

PID = tuple[int, int, int, int]  # P, I, D as 16.16 fixed point, and the speed at full duty [pulses/s]

DEFAULT_PID: PID = (0x00010000, 0x00008000, 0x00004000, 44000)


@dataclass
class Settings:
    """Raw, in the units of the wire."""

    serial_timeout: int = 0  # 100 ms; 0 is off
    pwm_mode: int = 1
    main_limits: tuple[int, int] = (60, 340)  # 0.1 V
    logic_limits: tuple[int, int] = (55, 340)
    velocity_pids: list[PID] = field(default_factory=lambda: [DEFAULT_PID, DEFAULT_PID])
    encoder_modes: list[int] = field(default_factory=lambda: [0, 0])
    current_limits: list[tuple[int, int]] = field(default_factory=lambda: [(1500, 0), (1500, 0)])  # 10 mA


class Flag(IntFlag):
    """The bits that this device can set, by the manual's names."""

    E_STOP = 0x00000001
    TEMPERATURE = 0x00000002
    MOTOR_1_DRIVER = 0x00000040
    MOTOR_1_CURRENT_WARNING = 0x00010000
    MAIN_LOW_WARNING = 0x00080000
    TEMPERATURE_WARNING = 0x00100000


WARM_C = 85.0  # the drive begins to limit here, and says so


def flag_of(trip: Trip) -> Flag:
    """Return the flag that stands for what has switched the drive off."""
    if isinstance(trip, OverTemperature):
        return Flag.TEMPERATURE
    return Flag.MAIN_LOW_WARNING if isinstance(trip, SupplyLost) else Flag.MOTOR_1_DRIVER
