"""The CiA 402 objects that every drive of ours has."""

from sim_backend.devices.canopen.data_types import I8, I16, I32, U16, U32
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object, record, variable

RO, RW = Access.RO, Access.RW
POSITION_UNIT_INCREMENTS = 0x00B50000
NO_WINDOW = 0xFFFFFFFF


def drive_profile(modes: int, velocity_unit: int, acceleration_unit: int, quick_stop: int) -> list[Object]:
    """Return them.

    Args:
        modes: 0x6502.
        velocity_unit: 0x60A9.
        acceleration_unit: 0x60AA.
        quick_stop: default of 0x605A.
    """
    return [
        variable(0x6007, "Abort connection option code", I16, RW, 1, low=0, high=3),
        variable(0x603F, "Error code", U16, RO, mappable=True),
        variable(0x6040, "Controlword", U16, RW, mappable=True),
        variable(0x6041, "Statusword", U16, RO, mappable=True),
        variable(0x605A, "Quick stop option code", I16, RW, quick_stop),
        variable(0x605B, "Shutdown option code", I16, RW, 0, low=0, high=1),
        variable(0x605C, "Disable operation option code", I16, RW, 1, low=0, high=1),
        variable(0x605E, "Fault reaction option code", I16, RW, 2, low=0, high=2),
        variable(0x6060, "Modes of operation", I8, RW, mappable=True),
        variable(0x6061, "Modes of operation display", I8, RO, mappable=True),
        variable(0x6062, "Position demand value", I32, RO, mappable=True),
        variable(0x6064, "Position actual value", I32, RO, mappable=True),
        variable(0x6065, "Following error window", U32, RW, NO_WINDOW),
        variable(0x6066, "Following error time out", U16, RW, 0),  # ms
        variable(0x6067, "Position window", U32, RW, NO_WINDOW),
        variable(0x6068, "Position window time", U16, RW, 0),  # ms
        variable(0x606C, "Velocity actual value", I32, RO, mappable=True),
        variable(0x6071, "Target torque", I16, RW, mappable=True),  # permille of rated torque
        variable(0x6076, "Motor rated torque", U32, RW),
        variable(0x6077, "Torque actual value", I16, RO, mappable=True),  # permille of rated torque
        variable(0x607A, "Target position", I32, RW, mappable=True),
        record(0x607D, "Software position limit", Entry(1, "Minimum", I32), Entry(2, "Maximum", I32)),  # 0, 0: none
        variable(0x6081, "Profile velocity", U32, RW, mappable=True),
        variable(0x6083, "Profile acceleration", U32, RW, mappable=True, low=1),
        variable(0x6084, "Profile deceleration", U32, RW, mappable=True, low=1),
        variable(0x6085, "Quick stop deceleration", U32, RW, mappable=True, low=1),
        variable(0x6086, "Motion profile type", I16, RW, 0, low=0, high=0),  # trapezoid
        variable(0x60A8, "SI unit position", U32, RO, POSITION_UNIT_INCREMENTS),
        variable(0x60A9, "SI unit velocity", U32, RO, velocity_unit),
        variable(0x60AA, "SI unit acceleration", U32, RO, acceleration_unit),
        variable(0x60B1, "Velocity offset", I32, RW, mappable=True),
        variable(0x60B2, "Torque offset", I16, RW, mappable=True),
        variable(0x60F4, "Following error actual value", I32, RO, mappable=True),
        variable(0x60FF, "Target velocity", I32, RW, mappable=True),
        variable(0x6502, "Supported drive modes", U32, RO, modes),
    ]
