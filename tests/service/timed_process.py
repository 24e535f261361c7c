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
from typing import NamedTuple

import numpy as np

from bench.control.clock import WallClock

FOLDER = "FRICTION_BENCH_TIMED_FOLDER"
MOST_CYCLES = 200_000
_PAIR = struct.Struct("=2d")


class TimedClock(WallClock):
    """Writes when each cycle is due and how late it begins into a file of its own: nothing else is done in a cycle."""

    numbers = itertools.count()

    def __init__(self) -> None:
        super().__init__()
        path = Path(os.environ[FOLDER]) / f"cycles-{next(self.numbers):03}"
        with path.open("w+b") as file:
            file.write(bytes(_PAIR.size * MOST_CYCLES))
            file.flush()
            self._pairs = mmap.mmap(file.fileno(), _PAIR.size * MOST_CYCLES)
        self._noted = 0

    def wait(self) -> None:
        due_s = self._deadline_s + self._period_s
        super().wait()
        _PAIR.pack_into(self._pairs, _PAIR.size * self._noted, due_s, perf_counter() - due_s)
        self._noted += 1


class Cycles(NamedTuple):
    """The cycles of one experiment, arrays of one length.

    Attributes:
        due_s: when each had to begin, by `perf_counter()`, which all processes of a machine share.
        late_s: how late it began.
    """

    due_s: np.ndarray
    late_s: np.ndarray


def read(folder: Path) -> list[Cycles]:
    """The cycles of each experiment, in the order of the experiments."""
    found = [np.fromfile(path).reshape(-1, 2) for path in sorted(folder.glob("cycles-*"))]
    return [Cycles(*pairs[: np.flatnonzero(pairs[:, 0])[-1] + 1].T) for pairs in found]


def main() -> None:
    """The bench process."""
    from bench.runs import runner
    from bench.runs.bench_process import process

    runner.WallClock = TimedClock  # type: ignore[misc]
    process.main()


def serve() -> None:
    """The command, with such a bench process."""
    from bench.cli import main as command
    from bench.runs.bench_process.remote_runner import RemoteRunner
    from bench.service import server

    server.RemoteRunner = partial(RemoteRunner, module="tests.service.timed_process")  # type: ignore[misc, assignment]
    os.environ[FOLDER] = sys.argv[1]
    sys.argv = ["friction-bench", *sys.argv[2:]]
    command()


if __name__ == "__main__":
    serve()
