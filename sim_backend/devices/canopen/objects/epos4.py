"""A drive with the objects of a maxon EPOS4, as far as our drives need them; not maxon's dictionary.

Names, types and ranges are those of a public EDS; units of the 0x2xxx and 0x3xxx objects are those of the firmware
specification as remembered. How 0x3203:01 tells the sign of the duty is not documented: here it is the magnitude.
"""

from sim_backend.devices.canopen.data_types import I8, I16, I32, U8, U16, U32
from sim_backend.devices.canopen.objects.communication import communication
from sim_backend.devices.canopen.objects.drive_profile import drive_profile
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object, record, variable
from sim_backend.devices.canopen.objects.family import Family, Rating, mode_bits, rpm, with_defaults

RO, RW = Access.RO, Access.RW
MAXON = 0x000000FB
VELOCITY_UNIT_RPM, ACCELERATION_UNIT_RPM_PER_S = 0x00B44700, 0x00C00300
_MODES = frozenset({1, 8, 10})
_NAME = "EPOS4-like drive, simulated"


def _objects(rating: Rating) -> list[Object]:
    profile = drive_profile(mode_bits(_MODES), VELOCITY_UNIT_RPM, ACCELERATION_UNIT_RPM_PER_S, quick_stop=6)
    defaults = {
        0x6007: 3,
        0x6076: round(rating.torque_n_m * 1e6),  # uN m
        0x6081: 1000,
        0x6083: 10_000,
        0x6084: 10_000,
        0x6085: 60_000,
    }
    return [
        *communication(MAXON, 0x63500000, 0x01700000, 1, _NAME, "0170"),
        record(0x2200, "Power supply", Entry(1, "Power supply voltage", U16, RO)),  # 0.1 V
        record(
            0x3001,
            "Motor data",
            Entry(1, "Nominal current", U32, RW, round(rating.current_a * 1e3)),  # mA
            Entry(2, "Output current limit", U32, RW, round(rating.peak_a * 1e3), mappable=True),  # mA
            Entry(5, "Torque constant", U32, RW, round(rating.torque_constant_n_m_a * 1e6)),  # uN m/A
        ),
        variable(0x30D0, "Current demand value", I32, RO, mappable=True),  # mA
        record(
            0x30D1,
            "Current actual values",
            Entry(1, "Current actual value averaged", I32, RO, mappable=True),  # mA
            Entry(2, "Current actual value", I32, RO, mappable=True),  # mA
        ),
        record(0x30D2, "Torque actual values", Entry(1, "Torque actual value averaged", I16, RO, mappable=True)),
        record(0x30D3, "Velocity actual values", Entry(1, "Velocity actual value averaged", I32, RO, mappable=True)),
        record(0x3201, "Temperatures", Entry(1, "Temperature power stage", I16, RO)),  # 0.1 degC
        record(0x3203, "PWM", Entry(1, "PWM duty cycle actual value", U16, RO, mappable=True)),  # permille
        *with_defaults(profile, defaults),
        record(
            0x60C2,
            "Interpolation time period",
            Entry(1, "Interpolation time period value", U8, RW, 1),
            Entry(2, "Interpolation time index", I8, RW, -3, low=-3, high=-3),
        ),
    ]


EPOS4 = Family(
    name="epos4",
    device_name=_NAME,
    modes=_MODES,
    objects=_objects,
    velocity_rad_s=rpm,
    acceleration_rad_s2=rpm,
    torque_unit_n_m=1e-6,
    own_objects=frozenset(
        {(0x2200, 1), (0x30D0, 0), (0x30D1, 1), (0x30D1, 2), (0x30D2, 1), (0x30D3, 1), (0x3201, 1), (0x3203, 1)}
    ),
    peak=(((0x3001, 2), lambda _rating: 1e-3),),
)
