"""Profile velocity (3) and cyclic synchronous velocity (9): the host says the speed, the drive keeps it."""

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import FOLLOWS, HALT, TARGET_REACHED, Mode, Seen, Units
from sim_backend.devices.canopen.modes.position_loop import PositionLoop


class Velocity(Mode):
    """Target velocity (0x60FF), approached by 0x6083 and 0x6084 where it is profiled; torque offset on top.

    Args:
        dictionary: the drive's.
        loop: its position controller: a speed is kept as the position that moves with it.
        units: of the drive.
        profiled: whether the speed changes with limited acceleration.
    """

    def __init__(self, dictionary: Dictionary, loop: PositionLoop, units: Units, profiled: bool) -> None:
        self._dictionary = dictionary
        self._loop = loop
        self._units = units
        self._profiled = profiled
        self._position = self._speed = 0.0

    def start(self, seen: Seen) -> None:
        """Begin with the speed that there is."""
        self._position, self._speed = seen.counts, seen.counts_per_s
        self._loop.start()

    def torque(self, seen: Seen) -> float:
        """Return the torque [permille]."""
        self._approach(self._wanted())
        self._position += self._speed * TICK_S
        return self._loop.torque(self._position, self._speed, seen) + self._dictionary.number(0x60B2)

    def status(self) -> int:
        """Whether the drive follows, or has reached the speed."""
        if not self._profiled:
            return FOLLOWS
        return TARGET_REACHED if self._speed == self._wanted() else 0

    def _wanted(self) -> float:
        number = self._dictionary.number
        if self._profiled and number(0x6040) & HALT:
            return 0.0
        return self._units.counts_per_s(number(0x60FF) + (0 if self._profiled else number(0x60B1)))

    def _approach(self, wanted: float) -> None:
        slower = abs(wanted) < abs(self._speed)
        step = self._units.counts_per_s2(self._dictionary.number(0x6084 if slower else 0x6083)) * TICK_S
        change = wanted - self._speed
        self._speed += max(-step, min(step, change)) if self._profiled else change
