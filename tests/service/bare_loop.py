"""What this machine allows at all: a process that does nothing but wait for the next of its deadlines.

It waits as the control loop does, with the same priority, alone in its interpreter, without garbage collection. What it
loses, no control loop on this machine could have kept.
"""

import gc
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from bench.control.scheduling import PRIORITY
from tests.service.timed_process import FOLDER, Cycles, TimedClock, read

ROOT = Path(__file__).parents[2]


def run(folder: Path, cycles: int, period_s: float) -> Cycles:
    """In a process of its own: its cycles.

    Args:
        folder: of its own; what is in it is overwritten.
        cycles: how many.
        period_s: from one deadline to the next.
    """
    folder.mkdir(exist_ok=True)
    words = [sys.executable, "-m", "tests.service.bare_loop", str(cycles), str(period_s)]
    environment = os.environ | {FOLDER: str(folder)}
    subprocess.run(words, check=True, cwd=ROOT, env=environment)
    return read(folder)[-1]


def main() -> None:
    """Wait `cycles` times."""
    cycles, period_s = int(sys.argv[1]), float(sys.argv[2])
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    clock = TimedClock()
    gc.disable()
    clock.start(period_s)
    for _ in range(cycles):
        clock.wait()


if __name__ == "__main__":
    main()
