"""How many cycles a second a drive sustains, found at connect with the power off."""

from collections.abc import Callable
from time import perf_counter

_CYCLES = 15


def sustained_rate_hz(cycle: Callable[[], object]) -> float:
    """Whole cycles, one after the other [Hz].

    The quickest counts: a busy host is no fault of the drive, and is seen in the cycles that are lost later.
    """
    lasted_s = []
    for _ in range(_CYCLES):
        began_s = perf_counter()
        cycle()
        lasted_s.append(perf_counter() - began_s)
    return 1.0 / min(lasted_s)
