"""A bench process that notes how late each of its cycles begins; and a service with such a one.

python -m tests.service.timed_process FOLDER serve --port 8000 ...
"""

import itertools
import mmap
import os
import struct
import sys
from functools import partial
from pathlib import Path
from time import perf_counter

import numpy as np

from bench.clock import WallClock

FOLDER = "FRICTION_BENCH_TIMED_FOLDER"
MOST_CYCLES = 200_000


class TimedClock(WallClock):
    """Writes how late each cycle begins [s] into a file of its own: nothing else is done in a cycle because of it."""

    numbers = itertools.count()

    def __init__(self) -> None:
        super().__init__()
        path = Path(os.environ[FOLDER]) / f"cycles-{next(self.numbers):03}"
        with path.open("w+b") as file:
            file.write(bytes(8 * MOST_CYCLES))
            file.flush()
            self._late = mmap.mmap(file.fileno(), 8 * MOST_CYCLES)
        self._noted = 0

    def wait(self) -> None:
        due_s = self._deadline_s + self._period_s
        super().wait()
        struct.pack_into("=d", self._late, 8 * self._noted, perf_counter() - due_s)
        self._noted += 1


def read(folder: Path) -> list[np.ndarray]:
    """How late the cycles of each experiment began [s], in the order of the experiments."""
    found = [np.fromfile(path) for path in sorted(folder.glob("cycles-*"))]
    return [late[: np.flatnonzero(late)[-1] + 1] for late in found]


def main() -> None:
    """The bench process."""
    from bench import runner
    from bench.bench_process import process

    runner.WallClock = TimedClock  # type: ignore[misc]
    process.main()


def serve() -> None:
    """The command, with such a bench process."""
    from bench.bench_process import RemoteRunner
    from bench.cli import main as command
    from bench.service import server

    server.RemoteRunner = partial(RemoteRunner, module="tests.service.timed_process")  # type: ignore[misc, assignment]
    os.environ[FOLDER] = sys.argv[1]
    sys.argv = ["friction-bench", *sys.argv[2:]]
    command()


if __name__ == "__main__":
    serve()
