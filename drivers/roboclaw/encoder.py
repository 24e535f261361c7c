"""The 32-bit encoder count, followed through its wraps."""

_TURN = 1 << 32
_HALF = 1 << 31


class EncoderCount:
    """Follows a count that wraps at 2**32; right as long as less than half of that passes between two readings.

    Args:
        first: the first reading, u32; the upper half of the range is taken for negative counts.
    """

    def __init__(self, first: int) -> None:
        self._last = first
        self.counts = first - _TURN if first >= _HALF else first

    def follow(self, reading: int) -> int:
        """The next reading, u32. Returns the count without wraps."""
        self.counts += (reading - self._last + _HALF) % _TURN - _HALF
        self._last = reading
        return self.counts
