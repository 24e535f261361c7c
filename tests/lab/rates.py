"""How long a whole diagnosis takes, and what rows cost: `python -m tests.lab.rates`.

Trials are recorded once by the simulated bench, through the public command, and each set is judged in a process of its
own: import, study (read, filter, fit), comparison, diagnosis with its pictures, and the report page are timed apart.
What an import compiles after an installation is compiled before. How a comparison grows is told by processes of their
own, of two sizes in turn.
Rows are streamed (`compensator.lab.model.streaming`): time and peak memory stand beside their number.
"""

import argparse
import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

from tests.lab.line import Line, print_table

MOST_EXPONENT = 1.05  # of a comparison's seconds by the number of trials
ROUNDS = 5  # of comparisons
MOST_GROWTH = 1.2  # of the time per row, and of the memory, from the fewest rows to the most
RECORD = ("run", "excitation", "--duration-s", "6", "--json")


class Case(NamedTuple):
    """A set of trials: six motions under each load, so often; and the seconds that its diagnosis may take."""

    trials: int
    loads_kg: str
    repeats: int
    asked_s: float = math.inf


CASES = (Case(24, "0,0.1", 2, 2.5), Case(216, "0,0.05,0.1", 12, 12.0))
GROWING = (Case(72, "0,0.05,0.1", 4), CASES[-1])


def main() -> None:
    """Measure everything, and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, help="keep the recorded sets here, and use those that are there")
    parser.add_argument("--most-trials", type=int, default=CASES[-1].trials, help="leave out larger sets")
    parser.add_argument("--rows", default="1e6,5e6,20e6", help="streamed; 50e6 takes some minutes")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="friction-bench-rates-") as temporary:
        folder = arguments.folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        cases = [case for case in CASES if case.trials <= arguments.most_trials]
        timed(CASES[0], folder)
        lines = [line for case in cases for line in diagnosing(case, folder)]
        if GROWING[-1] in cases:
            lines.append(growing(folder))
        print_table([*lines, *streaming(arguments.rows.split(","))])


def timed(case: Case, folder: Path, *options: str) -> dict[str, Any]:
    """What one process tells of a set, which is recorded where it is not there."""
    store = f"sqlite:///{folder / f'{case.trials}.sqlite'}"
    if not (folder / f"{case.trials}.sqlite").exists():
        words = ("--loads-kg", case.loads_kg, "--repeats", str(case.repeats))
        run(sys.executable, "-m", "bench.cli", "--store", store, *RECORD, *words)
    told: dict[str, Any] = json.loads(run(sys.executable, "-m", "tests.lab.timed_diagnosis", store, *options))
    return told


def diagnosing(case: Case, folder: Path) -> list[Line]:
    """A set from the store to the answer with its pictures."""
    told = timed(case, folder)
    return [*_summary(case, told), *(_part(name, *spent) for name, spent in told["laps"].items())]


def growing(folder: Path) -> Line:
    """The exponent by which a comparison's seconds of one core grow with the number of trials."""
    rounds = [[timed(case, folder, "--comparison")["laps"]["comparison"][1] for case in GROWING] for _ in range(ROUNDS)]
    few_s, many_s = (statistics.median(spent) for spent in zip(*rounds, strict=True))
    few, many = GROWING
    exponent = math.log(many_s / few_s) / math.log(many.trials / few.trials)
    return Line(
        f"comparison, {few.trials} to {many.trials} trials",
        f"n^{MOST_EXPONENT:g} at most",
        f"n^{exponent:.2f}, {few_s:.3f} to {many_s:.3f} s of one core, medians of {ROUNDS}",
        exponent <= MOST_EXPONENT,
    )


def streaming(counts: list[str]) -> list[Line]:
    """Rows one piece of one recording at a time: cost and memory, beside those of the fewest."""
    told = [json.loads(run(sys.executable, "-m", "tests.lab.timed_rows", count)) for count in counts]
    rates = [one["cpu_s"] / one["samples"] * 1e6 for one in told]
    grown = [one["peak_mb"] / told[0]["peak_mb"] for one in told]
    return [
        Line(
            f"{one['samples'] / 1e6:g} M rows streamed",
            "linear, flat",
            f"{one['cpu_s']:.1f} s of one core ({rate:.2f} s per M), {one['peak_mb']:.0f} MB",
            rate <= MOST_GROWTH * rates[0] and factor <= MOST_GROWTH,
        )
        for one, rate, factor in zip(told, rates, grown, strict=True)
    ]


def _summary(case: Case, told: dict[str, Any]) -> list[Line]:
    laps = {name: wall_s for name, (wall_s, _) in told["laps"].items()}
    whole_s = laps["study"] + laps["comparison"] + laps["diagnosis"]
    cpu_s = sum(told["laps"][name][1] for name in ("study", "comparison", "diagnosis"))
    what = f"{case.trials} trials x 6 s: study, comparison, diagnosis, {told['pictures']} pictures"
    measured = f"{whole_s:.2f} s ({cpu_s:.2f} s of one core), {told['peak_mb']:.0f} MB"
    return [Line(what, f"<= {case.asked_s:g} s", measured, whole_s <= case.asked_s)]


def _part(name: str, wall_s: float, cpu_s: float) -> Line:
    return Line(f"  {name}", "", f"{wall_s:.2f} s ({cpu_s:.2f} s of one core)", True)


def run(*command: str) -> str:
    """What a command prints."""
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    main()
