"""A RoboClaw's counter: 32 bits, with flags for having passed either end."""

_WRAP = 1 << 32
UNDERFLOW, BACKWARD, OVERFLOW = 1, 2, 4


class Counter:
    """Counts of one encoder."""

    def __init__(self) -> None:
        self._offset = 0
        self._raw = 0
        self._lap = 0
        self._flags = 0

    def follow(self, raw: int) -> None:
        """Take the encoder's own count."""
        if raw != self._raw:
            self._flags = self._flags & ~BACKWARD | (BACKWARD if raw < self._raw else 0)
        self._raw = raw
        lap = (raw - self._offset) // _WRAP
        if lap != self._lap:
            self._flags |= OVERFLOW if lap > self._lap else UNDERFLOW
        self._lap = lap

    def value(self) -> int:
        """Return the count, 0 .. 2^32 - 1."""
        return (self._raw - self._offset) % _WRAP

    def read(self) -> tuple[int, int]:
        """Return count and flags; having been read, the flags of passed ends are cleared."""
        flags = self._flags
        self._flags &= BACKWARD
        return self.value(), flags

    def set(self, value: int) -> None:
        """Let the present count be this."""
        self._offset = self._raw - value
        self._lap = value // _WRAP
