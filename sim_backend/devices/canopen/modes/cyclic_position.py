"""Cyclic synchronous position (8): the host says the position of every cycle, the drive goes straight there."""

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import FOLLOWS, Seen, Units
from sim_backend.devices.canopen.modes.position_loop import PositionLoop, within_limits


class CyclicPosition:
    """Target position (0x607A), interpolated over the time of 0x60C2; torque offset (0x60B2) on top."""

    def __init__(self, dictionary: Dictionary, loop: PositionLoop, units: Units) -> None:
        self._dictionary = dictionary
        self._units = units
        self._loop = loop
        self._from = self._to = self._now = 0.0
        self._since_s = 0.0

    def start(self, seen: Seen) -> None:
        """Hold the position until a target comes."""
        self._from = self._to = self._now = seen.counts
        self._since_s = seen.time_s
        self._loop.start()

    def aim(self, time_s: float) -> None:
        """A target has come."""
        target = within_limits(self._dictionary.number(0x607A), self._dictionary)
        self._from, self._to = self._now, self._units.counts(target)
        self._since_s = time_s

    def torque(self, seen: Seen) -> float:
        """Return the torque [permille]."""
        period_s = self._dictionary.number(0x60C2, 1) * 10.0 ** self._dictionary.number(0x60C2, 2)
        # at the end of the coming tick
        gone = (seen.time_s + TICK_S - self._since_s) / period_s if period_s > 0.0 else 2.0
        under_way = gone < 1.0 + 1e-6
        self._now = self._from + (self._to - self._from) * min(gone, 1.0)
        counts_per_s = (self._to - self._from) / period_s if under_way else 0.0
        return self._loop.torque(self._now, counts_per_s, seen) + self._dictionary.number(0x60B2)

    def position(self) -> float | None:
        """Return the position that is demanded [counts]."""
        return self._now

    def status(self) -> int:
        """The drive follows."""
        return FOLLOWS
