"""The status flags of current firmware (command 90)."""

from enum import IntFlag

from sim_backend.faults.script import OverTemperature, SupplyLost, Trip


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
