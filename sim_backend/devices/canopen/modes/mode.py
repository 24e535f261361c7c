"""What the drive asks of a mode."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

TARGET_REACHED, FOLLOWS, SET_POINT_TAKEN = 1 << 10, 1 << 12, 1 << 12
HOMED, HOMING_FAILED = 1 << 12, 1 << 13
HALT = 1 << 8


class Seen(NamedTuple):
    """What the drive measures, in the units of its encoder."""

    time_s: float
    counts: float
    counts_per_s: float


class Units(NamedTuple):
    """From the drive's units of position, velocity and acceleration to counts, counts/s and counts/s2."""

    counts: Callable[[float], float]
    counts_per_s: Callable[[float], float]
    counts_per_s2: Callable[[float], float]


class Mode(Protocol):
    """One mode of operation. Torque is in permille of the rated torque."""

    def start(self, seen: Seen) -> None:
        """Begin from where the motor is."""

    def torque(self, seen: Seen) -> float:
        """Return the torque of the coming tick."""

    def position(self) -> float | None:
        """Return the position that is demanded [counts]; None where none is."""
        return None

    def status(self) -> int:
        """Return the mode's bits of the statusword."""
