"""One row of the benchmark: what is asked, what was measured, whether that is met."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from time import perf_counter

MOST_RATIO = 1.25  # of a driver's cycle to the same exchange written barely with the library


def row(what: str, asked: str, measured: str, met: bool | None) -> str:
    """The row; `met` is None where nothing is asked."""
    verdict = {True: "met", False: "NOT MET", None: ""}[met]
    return f"{what:<58} {asked:<14} {measured:<44} {verdict}".rstrip()


def heading() -> str:
    """Above the rows."""
    return row("", "asked", "measured", None)


def ratio_row(what: str, bare_s: float, driver_s: float, is_asked: bool = True) -> str:
    """A driver's cycle beside the bare one."""
    ratio = driver_s / bare_s
    measured = f"{ratio:.2f} (bare {1e6 * bare_s:.0f} us, driver {1e6 * driver_s:.0f} us)"
    if not is_asked:
        return row(what, "", measured, None)
    return row(what, f"<= {MOST_RATIO:g}", measured, ratio <= MOST_RATIO)


Cycle = Callable[[], object]


def quickest(
    *ways: Callable[[], AbstractContextManager[Cycle]], rounds: int = 25, cycles: int = 60
) -> tuple[float, ...]:
    """Seconds a cycle of each way: the quickest of short rounds, of which a busy machine leaves some in peace."""
    best = [1.0] * len(ways)
    for _ in range(rounds):
        for place, way in enumerate(ways):
            with way() as cycle:
                best[place] = min(best[place], seconds_a_cycle(cycle, cycles))
    return tuple(best)


def seconds_a_cycle(cycle: Cycle, count: int) -> float:
    """Of so many cycles, after one that does not count."""
    cycle()
    began_s = perf_counter()
    for _ in range(count):
        cycle()
    return (perf_counter() - began_s) / count
