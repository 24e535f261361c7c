"""A drive that keeps to CiA 402, with two objects of its own for duty and temperature."""

from sim_backend.devices.canopen.data_types import I8, I16, U8, U16, U32
from sim_backend.devices.canopen.objects.communication import communication
from sim_backend.devices.canopen.objects.drive_profile import drive_profile
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object, record, variable
from sim_backend.devices.canopen.objects.family import Family, Rating, increment, mode_bits, with_defaults

RO, RW = Access.RO, Access.RW
VELOCITY_UNIT_INCREMENTS_PER_S, ACCELERATION_UNIT_INCREMENTS_PER_S2 = 0x00B50300, 0x00B55700
_MODES = frozenset({1, 3, 4, 8, 9, 10})
_NAME = "friction-bench CiA 402 drive, simulated"


def _objects(rating: Rating) -> list[Object]:
    peak = round(rating.peak_a / rating.current_a * 1000.0)
    turn = rating.counts_per_turn
    units = VELOCITY_UNIT_INCREMENTS_PER_S, ACCELERATION_UNIT_INCREMENTS_PER_S2
    profile = drive_profile(mode_bits(_MODES), *units, quick_stop=2)
    defaults = {
        0x6076: max(round(rating.torque_n_m * 1e3), 1),  # mN m
        0x6081: round(10.0 * turn),
        0x6083: round(200.0 * turn),
        0x6084: round(200.0 * turn),
        0x6085: round(1000.0 * turn),
    }
    return [
        *communication(0, 0x402, 1, 1, _NAME, "1.0"),
        variable(0x2001, "PWM duty cycle actual value", I16, RO, mappable=True),  # signed, permille
        variable(0x2002, "Power stage temperature", I16, RO, mappable=True),  # 0.1 degC
        *with_defaults(profile, defaults),
        variable(0x605D, "Halt option code", I16, RW, 1, low=1, high=1),
        variable(0x6072, "Max torque", U16, RW, peak, mappable=True),
        variable(0x6073, "Max current", U16, RW, peak),
        variable(0x6074, "Torque demand", I16, RO, mappable=True),
        variable(0x6075, "Motor rated current", U32, RW, round(rating.current_a * 1e3)),  # mA
        variable(0x6078, "Current actual value", I16, RO, mappable=True),  # permille of rated current
        variable(0x6079, "DC link circuit voltage", U32, RO, mappable=True),  # mV
        variable(0x6087, "Torque slope", U32, RW, 100_000),  # permille/s
        record(
            0x608F,
            "Position encoder resolution",
            Entry(1, "Encoder increments", U32, RO, round(turn)),
            Entry(2, "Motor revolutions", U32, RO, 1),
        ),
        record(
            0x60C2,
            "Interpolation time period",
            Entry(1, "Interpolation time period value", U8, RW, 10),
            Entry(2, "Interpolation time index", I8, RW, -3, low=-4, high=0),
        ),
        variable(0x60FD, "Digital inputs", U32, RO, mappable=True),  # bit 3: interlock, here safe torque off
        record(
            0x60FE,
            "Digital outputs",
            Entry(1, "Physical outputs", U32, RW, 1, mappable=True),  # bit 0: set brake
            Entry(2, "Bit mask", U32, RW, 1, mappable=True),
        ),
    ]


GENERIC = Family(
    name="generic",
    device_name=_NAME,
    modes=_MODES,
    objects=_objects,
    velocity_rad_s=increment,
    acceleration_rad_s2=increment,
    torque_unit_n_m=1e-3,
    own_objects=frozenset({(0x2001, 0), (0x2002, 0)}),
    peak=(
        ((0x6072, 0), lambda rating: rating.current_a * 1e-3),
        ((0x6073, 0), lambda rating: rating.current_a * 1e-3),
    ),
)
