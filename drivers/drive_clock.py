"""A drive's own clock."""


class DriveClock:
    """The drive's own clock, followed through its wraps.

    Args:
        step_s: one step of its register [s].
        bits: of its register.
    """

    def __init__(self, step_s: float, bits: int) -> None:
        self._turn_s = step_s * 2.0**bits
        self._last_s: float | None = None
        self._time_s = 0.0

    def follow(self, reading_s: float) -> float:
        """The next reading [s]. Returns the time without wraps [s]."""
        if self._last_s is None:
            self._time_s = reading_s
        else:
            self._time_s += (reading_s - self._last_s) % self._turn_s
        self._last_s = reading_s
        return self._time_s
