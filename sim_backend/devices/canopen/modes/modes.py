"""The modes of operation by their numbers."""

from collections.abc import Callable, Iterable

from sim_backend.devices.axis import Axis
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.cyclic_position import CyclicPosition
from sim_backend.devices.canopen.modes.cyclic_torque import CyclicTorque
from sim_backend.devices.canopen.modes.homing import NEEDED, Homing, index_of
from sim_backend.devices.canopen.modes.mode import Mode, Units
from sim_backend.devices.canopen.modes.position_loop import PositionLoop
from sim_backend.devices.canopen.modes.profile_position import ProfilePosition
from sim_backend.devices.canopen.modes.profile_torque import ProfileTorque
from sim_backend.devices.canopen.modes.velocity import Velocity


def make_modes(
    numbers: Iterable[int],
    dictionary: Dictionary,
    loop: PositionLoop,
    units: Units,
    axis: Axis,
    counts_per_turn: float,
) -> dict[int, Mode]:
    """Return those of the numbers (0x6060) that make the motor turn."""
    known: dict[int, Callable[[], Mode]] = {
        1: lambda: ProfilePosition(dictionary, loop, units),
        3: lambda: Velocity(dictionary, loop, units, profiled=True),
        4: lambda: ProfileTorque(dictionary),
        6: lambda: Homing(dictionary, loop, units, index_of(axis, counts_per_turn), axis.count_from, counts_per_turn),
        8: lambda: CyclicPosition(dictionary, loop, units),
        9: lambda: Velocity(dictionary, loop, units, profiled=False),
        10: lambda: CyclicTorque(dictionary),
    }
    if not all(place in dictionary for place in NEEDED):
        del known[6]
    return {number: known[number]() for number in numbers if number in known}
