"""What a RoboClaw remembers, with the defaults of its manual."""

from dataclasses import dataclass, field

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
