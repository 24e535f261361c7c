"""What the host takes away: on each processor a process that does nothing but wait, before the control loop.

    python -m tests.service.host_watch PROCESSOR

Nothing of ours, and no other program, can keep it from its processor: its priority is above the loop's. When it wakes
late all the same, the machine itself was stopped, or its kernel was busy. A control loop that was late in the same
moments was late for the same reason.
"""

import gc
import os
import select
import subprocess
import sys
from bisect import bisect_left
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import perf_counter

import numpy as np

from bench.control.scheduling import PRIORITY

ROOT = Path(__file__).parents[2]
PERIOD_S = 0.0005
LATE_S = 0.00025  # an ordinary waking-up takes less
LONGEST_S = 30.0  # of a gap
SHORTEST_S = 0.0001  # lateness that is looked at
Gaps = list[tuple[float, float]]
"""When the processor was away: from, until, by `perf_counter()` [s]."""


@contextmanager
def watched() -> Iterator[Gaps]:
    """The gaps of all processors, in order; there when the block ends. None where no such priority is permitted."""
    found: Gaps = []
    words = [sys.executable, "-m", "tests.service.host_watch"]
    watches = [
        subprocess.Popen([*words, str(number)], cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        for number in sorted(os.sched_getaffinity(0))
    ]
    try:
        for watch in watches:
            assert watch.stdout is not None
            watch.stdout.readline()  # it watches
        yield found
    finally:
        for watch in watches:
            said, _ = watch.communicate()  # closes its input: it ends
            found += [(float(begin), float(end)) for begin, end in map(str.split, said.decode().splitlines())]
        found.sort()


def covered_s(gaps: Gaps, begin_s: float, end_s: float) -> float:
    """For how much of a stretch at least one processor was away [s]; the gaps in the order in which they began."""
    total_s, reached_s = 0.0, begin_s
    for gap_begin_s, gap_end_s in gaps[max(bisect_left(gaps, (begin_s - LONGEST_S,)), 0) :]:
        if gap_begin_s >= end_s:
            break
        begin, end = max(gap_begin_s, reached_s), min(gap_end_s, end_s)
        if end > begin:
            total_s += end - begin
            reached_s = end
    return total_s


def lost_cycles(late_s: np.ndarray, period_s: float) -> int:
    """Cycles that were lost, as the loop's clock counts them: whole periods of each lateness."""
    late = late_s[late_s > period_s]
    return int(np.floor(late / period_s).sum())


def own_lateness_s(due_s: np.ndarray, late_s: np.ndarray, gaps: Gaps) -> np.ndarray:
    """How late cycles were by no fault of the host's [s]: without what they were late while a processor was away."""
    own_s = late_s.copy()
    for place in np.flatnonzero(late_s > SHORTEST_S) if gaps else ():
        own_s[place] -= covered_s(gaps, due_s[place], due_s[place] + late_s[place])
    return own_s


def main() -> None:
    """Watch until the input ends; then print the gaps."""
    os.sched_setaffinity(0, {int(sys.argv[1])})
    permitted = False
    with suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY + 1))
        permitted = True
    gc.disable()
    gaps: Gaps = []
    sys.stdout.write("watching\n")
    sys.stdout.flush()
    due_s = perf_counter() + PERIOD_S
    while not select.select([sys.stdin], [], [], PERIOD_S)[0]:
        now_s = perf_counter()
        if now_s - due_s > LATE_S:
            gaps.append((due_s, now_s))
        due_s = now_s + PERIOD_S
    if permitted:  # else it waited for other programs, and tells nothing of the host
        sys.stdout.writelines(f"{begin_s!r} {end_s!r}\n" for begin_s, end_s in gaps)


if __name__ == "__main__":
    main()
