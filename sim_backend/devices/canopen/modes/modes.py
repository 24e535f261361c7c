"""The modes of operation by their numbers."""

from collections.abc import Callable, Iterable

from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.cyclic_position import CyclicPosition
from sim_backend.devices.canopen.modes.cyclic_torque import CyclicTorque
from sim_backend.devices.canopen.modes.mode import Mode
from sim_backend.devices.canopen.modes.position_loop import PositionLoop
from sim_backend.devices.canopen.modes.profile_position import ProfilePosition
from sim_backend.devices.canopen.modes.profile_torque import ProfileTorque


def make_modes(
    numbers: Iterable[int], dictionary: Dictionary, loop: PositionLoop, counts_per_s: Callable[[int], float]
) -> dict[int, Mode]:
    """Return those of the numbers (0x6060).

    Args:
        numbers: which modes.
        dictionary: the drive's.
        loop: its position controller.
        counts_per_s: speed of a number in the drive's unit of velocity.
    """
    known: dict[int, Callable[[], Mode]] = {
        1: lambda: ProfilePosition(dictionary, loop, counts_per_s),
        4: lambda: ProfileTorque(dictionary),
        8: lambda: CyclicPosition(dictionary, loop),
        10: lambda: CyclicTorque(dictionary),
    }
    return {number: known[number]() for number in numbers}
