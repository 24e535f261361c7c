"""What paces the control loop: the wall clock for hardware, nothing for the simulation."""

import time
from typing import Protocol

_SPIN_S = 0.0002  # before the deadline; the operating system's wake-up is later than this now and then only


class Clock(Protocol):
    """Paces control cycles."""

    overruns: int
    """Cycles that were lost because one began more than a whole period late, since the clock was made."""

    patience_s: float
    """How long a cycle may wait for the store [s]: nothing is lost by it where time itself waits."""

    def start(self, period_s: float) -> None:
        """The first cycle begins now."""

    def wait(self) -> None:
        """Return when the next cycle begins."""


class VirtualClock:
    """Never waits: time is whatever the drive's stamps say."""

    overruns = 0
    patience_s = 10.0

    def start(self, period_s: float) -> None:
        """Nothing to do."""

    def wait(self) -> None:
        """Return at once."""


class WallClock:
    """Follows the wall clock: sleeps most of the period, and spins through the last part of it.

    Deadlines lie on a grid, so lateness of one cycle does not shift the next. After a cycle that is late by more
    than a period the grid starts anew: cycles are lost, and counted, but never made up for in a burst.
    """

    patience_s = 0.0

    def __init__(self) -> None:
        self.overruns = 0
        self._period_s = 0.0
        self._deadline_s = 0.0

    def start(self, period_s: float) -> None:
        """The first cycle begins now."""
        self._period_s = period_s
        self._deadline_s = time.perf_counter()

    def wait(self) -> None:
        """Return when the next cycle begins, at once where it should have begun already."""
        self._deadline_s += self._period_s
        remaining_s = self._deadline_s - time.perf_counter()
        if remaining_s < -self._period_s:
            self.overruns += int(-remaining_s / self._period_s)
            self._deadline_s -= remaining_s
            return
        if remaining_s > _SPIN_S:
            time.sleep(remaining_s - _SPIN_S)
        while time.perf_counter() < self._deadline_s:
            pass
