"""What begins anew now and then, followed beyond that: a drive's own clock, a position within one turn."""


class DriveClock:
    """The drive's own clock, followed through its wraps.

    Readings within one step of it rise, too: each lies half-way from the one before to the step's end. A late cycle is
    followed by the next at once, and a record whose time stands still is none.
    """

    def __init__(self, step_s: float, bits: int) -> None:
        self._step_s, self._turn_s = step_s, step_s * 2.0**bits
        self._last_s: float | None = None
        self._time_s = 0.0
        self._rest = 1.0  # of the step, behind the last reading

    def follow(self, reading_s: float) -> float:
        """The next reading [s]. Returns the time without wraps [s]."""
        if reading_s == self._last_s:
            self._rest *= 0.5
            return self._time_s + self._step_s * (1.0 - self._rest)
        if self._last_s is None:
            self._time_s = reading_s
        else:
            self._time_s += (reading_s - self._last_s) % self._turn_s
        self._last_s, self._rest = reading_s, 1.0
        return self._time_s


class Turns:
    """Follows a count that begins anew with each turn, by the speed that is told with it.

    Right as long as speed times time is known to less than half a turn: from one cycle to the next, and through a
    pause in which the shaft stands or turns steadily. Whoever turns it by hand by more, in a pause, moves the zero.
    """

    def __init__(self, counts_per_turn: int) -> None:
        self._turn = counts_per_turn
        self._last: tuple[float, int, float] | None = None  # time, count, speed

    def follow(self, count: int, counts_s: float, time_s: float) -> int:
        """The next count. Returns it without turns.

        Args:
            count: 0 .. counts_per_turn - 1.
            counts_s: the speed [1/s].
            time_s: of both [s].
        """
        if self._last is None:
            whole = count
        else:
            last_s, last, last_counts_s = self._last
            expected = last + 0.5 * (counts_s + last_counts_s) * (time_s - last_s)
            half = self._turn / 2
            whole = round(expected + (count - expected + half) % self._turn - half)
        self._last = time_s, whole, counts_s
        return whole
