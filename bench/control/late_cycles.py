"""Control cycles lost by a late host: in a run that goes on, and while the joint brakes."""

from collections import deque
from collections.abc import Iterator
from math import ceil

from bench.control.clock import Clock

BRAKING_S = 0.5  # longest wait for a quick stop to bring the joint to rest
TOLD_S = 0.5  # how long after a loss a limit that trips is put down to it, too
LEAST_S = 0.03  # lost within that time: less moves no joint far
MOST_KEPT = 100


class LateCycles:
    """Remembers when the host was late last.

    Between two cycles the drive goes on with the last command. A current moves the joint away from its set point while
    the host is late. The limit that trips then is right, but its message has to name the late cycles as the cause.
    """

    def __init__(self, clock: Clock, period_s: float) -> None:
        self._clock = clock
        self._period_s = period_s
        self._seen = clock.overruns
        self._lost: deque[tuple[int, int]] = deque(maxlen=MOST_KEPT)  # at which cycle, how many

    def look(self, cycle: int) -> None:
        """When a cycle begins."""
        overruns = self._clock.overruns
        if overruns != self._seen:
            self._lost.append((cycle, overruns - self._seen))
            self._seen = overruns

    def explain(self, cycle: int) -> str:
        """What the drive did meanwhile, where a good few cycles were lost a moment ago; else ""."""
        lost = sum(lost for at, lost in self._lost if (cycle - at) * self._period_s <= TOLD_S)
        if not moves_a_joint(lost, self._period_s):
            return ""
        late = f"the host was late by {lost * self._period_s:.3g} s ({lost} cycles) just before"
        return f"; {late}, and the drive went on with the last command meanwhile: see what kept the host busy"


def moves_a_joint(lost: int, period_s: float) -> bool:
    """Whether so many lost cycles are enough for a joint to be elsewhere when the host is back."""
    return lost * period_s >= LEAST_S


def braking_cycles(clock: Clock, period_s: float) -> Iterator[None]:
    """The cycles for which a joint may brake. Those that a late host loses count: a brake is given a time."""
    done, lost_before = 0, clock.overruns
    while done + clock.overruns - lost_before < ceil(BRAKING_S / period_s):
        yield
        done += 1
