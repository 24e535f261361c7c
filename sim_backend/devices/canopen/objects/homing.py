"""The drive of `generic`, with homing: the objects of CiA 402-2, and one of its own for the torque against a stop."""

from dataclasses import replace

from sim_backend.devices.canopen.data_types import I8, I32, U16, U32
from sim_backend.devices.canopen.objects.entry import Entry, Object, record, variable
from sim_backend.devices.canopen.objects.family import Rating, mode_bits, with_defaults
from sim_backend.devices.canopen.objects.generic import GENERIC

_MODES = GENERIC.modes | {6}


def homing_objects(rating: Rating) -> list[Object]:
    """Return what homing needs."""
    turn = rating.counts_per_turn
    return [
        variable(0x5FF0, "Homing torque against an end stop", U16, default=500),  # permille of rated torque
        variable(0x607C, "Home offset", I32),
        variable(0x6098, "Homing method", I8, default=37),
        record(
            0x6099,
            "Homing speeds",
            Entry(1, "Speed during search for switch", U32, default=round(turn)),
            Entry(2, "Speed during search for zero", U32, default=round(0.2 * turn)),
        ),
        variable(0x609A, "Homing acceleration", U32, default=round(50.0 * turn)),
    ]


def _objects(rating: Rating) -> list[Object]:
    return [*with_defaults(GENERIC.objects(rating), {0x6502: mode_bits(_MODES)}), *homing_objects(rating)]


HOMING = replace(GENERIC, name="homing", modes=_MODES, objects=_objects)
