"""When a quick stop is over, where the drive does not say so: its count stands. Pure."""

from math import nan

_CYCLES = 3  # without a count: the joint stands


class Standstill:
    """Follows a position from one cycle to the next."""

    def __init__(self) -> None:
        self._last = nan
        self._cycles = 0

    def restart(self) -> None:
        """Braking begins."""
        self._last, self._cycles = nan, 0

    def stands(self, position: float) -> bool:
        """Whether the position, in any unit, has been the same for some cycles; this one's is given."""
        self._cycles = self._cycles + 1 if position == self._last else 0
        self._last = position
        return self._cycles >= _CYCLES
