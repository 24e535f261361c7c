"""How long a whole diagnosis takes, and what rows cost: `python -m tests.lab.rates`.

Trials are recorded once by the simulated bench, through the public command, and each set is judged in a process of its
own: import, study (read, filter, fit), comparison, diagnosis with its pictures, and the report page are timed apart.
Rows are streamed (`compensator.lab.model.streaming`): time and peak memory stand beside their number.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

from tests.lab.line import Line, print_table

MOST_GROWTH = 1.2  # of the time per row, and of the memory, from the fewest rows to the most
RECORD = ("run", "excitation", "--duration-s", "6", "--json")


class Case(NamedTuple):
    """A set of trials: six motions under each load, so often; and the seconds that its diagnosis may take."""

    trials: int
    loads_kg: str
    repeats: int
    asked_s: float


CASES = (Case(24, "0,0.1", 2, 2.5), Case(216, "0,0.05,0.1", 12, 12.0))


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
        lines = [line for case in cases for line in diagnosing(case, folder)]
        print_table([*lines, *streaming(arguments.rows.split(","))])


def diagnosing(case: Case, folder: Path) -> list[Line]:
    """A set from the store to the answer with its pictures."""
    store = f"sqlite:///{folder / f'{case.trials}.sqlite'}"
    if not (folder / f"{case.trials}.sqlite").exists():
        words = ("--loads-kg", case.loads_kg, "--repeats", str(case.repeats))
        run(sys.executable, "-m", "bench.cli", "--store", store, *RECORD, *words)
    told = json.loads(run(sys.executable, "-m", "tests.lab.timed_diagnosis", store))
    return [*_summary(case, told), *(_part(name, *spent) for name, spent in told["laps"].items())]


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
