"""Two processes beside one on eight studies: `python -m tests.parallel.two_processes`.

The studies are of the simulated bench, each of trials of its own. One process and two diagnose all of them in turn, by
the public command in a process of its own, start and imports included; medians and spreads are of the rounds. The wall
clock decides, so that the load of the machine stands beside it: the figure means nothing where others work.
"""

import argparse
import ctypes
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from bench.store import Store
from bench.study.create import create_study
from tests.lab.line import Line, print_table

STUDIES, ROUNDS = 8, 5
ASKED = 1.7
PR_SET_CHILD_SUBREAPER = 36  # linux/prctl.h
RECORD = ("run", "excitation", "--duration-s", "6", "--json")


class Taken(NamedTuple):
    """What one command took, by the clock and of the processors, its children's among them [s]."""

    wall_s: float
    cpu_s: float


def main() -> None:
    """Measure in turn, and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--repeats", type=int, default=3, help="of six motions under three loads, for each study")
    arguments = parser.parse_args()
    # workers are forks of a process that outlives the command: it becomes ours, and its time is counted
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    with tempfile.TemporaryDirectory(prefix="friction-bench-two-") as folder:
        store = f"sqlite:///{Path(folder) / 'bench.sqlite'}"
        trials = prepared(store, arguments.repeats)
        print(f"load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores", flush=True)
        rounds = [[diagnosing(store, workers) for workers in (1, 2)] for _ in range(arguments.rounds)]
    print_table(lines(rounds, f"{STUDIES} studies of {trials} trials"))
    print(f"load of the machine after: {os.getloadavg()[0]:.1f}, the benchmark's own included")


def prepared(store: str, repeats: int) -> int:
    """Record, each study under loads of its own, and make the studies; how many trials each has."""
    for number in range(STUDIES):
        loads_kg = ",".join(f"{kg - 0.002 * number:g}" for kg in (0.03, 0.06, 0.1))
        command(store, *RECORD, "--loads-kg", loads_kg, "--repeats", str(repeats))
    with Store.open(store) as opened:
        experiments = sorted(opened.experiments(), key=lambda one: one.id)
        for experiment in experiments:
            create_study(opened, f"of experiment {experiment.id}", [experiment.id])
        return len(opened.trials(experiments[0].id))


def diagnosing(store: str, workers: int) -> Taken:
    """The command, with so many processes."""
    began_s, began_cpu_s = time.perf_counter(), _children_s()
    command(store, "study", "diagnose-many", "--workers", str(workers), "--json")
    wall_s = time.perf_counter() - began_s
    with suppress(ChildProcessError):
        while True:
            os.wait()
    return Taken(wall_s, _children_s() - began_cpu_s)


def lines(rounds: list[list[Taken]], what: str) -> list[Line]:
    """What each took, and how many times two are one."""
    ratios = [one.wall_s / two.wall_s for one, two in rounds]
    told = [
        Line(
            f"{what}, {name}",
            "",
            f"{_spread([taken[index].wall_s for taken in rounds])} s by the clock, "
            f"{_spread([taken[index].cpu_s for taken in rounds])} s of one core",
            True,
        )
        for index, name in enumerate(("one process", "two processes"))
    ]
    median = statistics.median(one.wall_s for one, _ in rounds) / statistics.median(two.wall_s for _, two in rounds)
    measured = f"{median:.2f}, rounds {min(ratios):.2f} .. {max(ratios):.2f}"
    return [*told, Line("two processes, times one, by the medians", f">= {ASKED}", measured, median >= ASKED)]


def command(store: str, *words: str) -> None:
    """One of ours; it says nothing here."""
    subprocess.run((sys.executable, "-m", "bench.cli", "--store", store, *words), check=True, capture_output=True)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _spread(values: list[float]) -> str:
    return f"{statistics.median(values):.2f} ({min(values):.2f} .. {max(values):.2f})"


if __name__ == "__main__":
    main()
