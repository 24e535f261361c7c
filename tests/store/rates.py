"""What the store and the export manage, beside what was asked and beside the plain way: `python -m tests.store.rates`.

Rates that are compared are measured in the same run, one after the other. Short ones are the best of several,
because other programs share the machine.
"""

import argparse
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np
from sqlalchemy import insert

from bench.config.channels import RECORDED
from bench.store import Store, TrialWriter
from bench.store.schema import TRIAL, TRIAL_CONDITION
from bench.store.tables.experiments import now
from bench.store.tables.trial_search import TrialQuery
from tests.lab.line import Line, print_table

CHANNELS = RECORDED[:10]
APPENDED_ROWS = 32_768
COMPARED_ROWS = 200_000  # the plain ways are slow: their rate is taken from fewer rows
REPEATS = 7


# most memory of the process itself: what the kernel tells the parent includes the parent's own, of before the start
MEASURED = """
import re, sys
from pathlib import Path
from bench.cli import main
try:
    main()
finally:
    print(re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1], file=sys.stderr)
"""


def main() -> None:
    """Measure everything, and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--export-rows", type=int, default=10_000_000, help="rows of the trial that is exported")
    parser.add_argument("--trials", type=int, default=100_000, help="trials in the list")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="friction-bench-rates-") as folder:
        lines = [*writing(Path(folder)), *exporting(Path(folder), arguments.export_rows)]
        lines += [*listing(Path(folder), arguments.trials), *plotting(Path(folder)), *beside_a_server()]
    print_table(lines)


def writing(folder: Path) -> list[Line]:
    """Blocks through the store, against one row of a table per sample row."""
    rows = signals(1_000_000)
    with Store.open(f"sqlite:///{folder / 'blocks.sqlite'}") as store:
        ours = len(rows) / best(3, lambda: append(trial_of(store), rows))
    plain = COMPARED_ROWS / best(3, lambda: row_per_sample(folder / "rows.sqlite", rows[:COMPARED_ROWS]))
    ratio = ours / plain
    return [
        Line("store, sample rows of 10 channels", ">= 1 M/s", f"{ours / 1e6:.2f} M/s", ours >= 1e6),
        Line("  times executemany, a row per sample", ">= 5", f"{ratio:.1f} ({plain / 1e6:.2f} M/s)", ratio >= 5),
    ]


def exporting(folder: Path, count: int) -> list[Line]:
    """The command that exports a trial, in a process of its own, against pandas.to_csv."""
    path = folder / "export.sqlite"
    with Store.open(f"sqlite:///{path}") as store:
        writer = trial_of(store)
        piece = signals(500_000)
        while writer.rows < count:
            later = np.array([writer.rows * 1e-3, *[0.0] * 9])
            append(writer, piece[: count - writer.rows] + later)
    started_s = time.perf_counter()
    ours_bytes, peak_bytes = export(path, writer.trial_id)
    ours = count / (time.perf_counter() - started_s)
    plain = COMPARED_ROWS / best(1, lambda: to_csv(piece[:COMPARED_ROWS], folder / "pandas.csv"))
    path.unlink()
    ratio, peak_mb = ours / plain, peak_bytes / 1e6
    measured = f"{ratio:.1f} ({ours / 1e3:.0f} against {plain / 1e3:.0f} k rows/s)"
    size = f"export of {count / 1e6:g} M rows as CSV ({ours_bytes / 1e9:.2f} GB)"
    return [
        Line(f"{size}, times pandas.to_csv", ">= 3", measured, ratio >= 3),
        Line("  peak memory of the whole process", "< 200 MB", f"{peak_mb:.0f} MB", peak_mb < 200),
    ]


def listing(folder: Path, count: int) -> list[Line]:
    """One page of a long list, by different filters."""
    with Store.open(f"sqlite:///{folder / 'list.sqlite'}") as store:
        fill(store, count)
        asked = {
            "newest experiment": {"experiment_id": count // 1000},
            "kind and outcome": {"kind": "steps", "outcome": "tripped"},
            "load 40 g .. 60 g, balanced": {"conditions": {"load_kg": (0.04, 0.06), "balanced": True}},
            "text nobody has": {"conditions": {"grease": "none"}},
            "source, last page": {"source": "real", "offset": count // 2 - 100},
        }
        found = []
        for name, filters in asked.items():
            taken_ms = 1e3 * best(REPEATS, lambda filters=filters: store.trials(**filters, limit=100))
            what = f"list of {count} trials, page of 100: {name}"
            found.append(Line(what, "< 50 ms", f"{taken_ms:.1f} ms", taken_ms < 50))
        looked_for = {
            "newest first": TrialQuery(descending=True),
            "sorted by name": TrialQuery(sort="name"),
            "one word": TrialQuery(words=("77",)),
            "two words": TrialQuery(words=("steps", "nlgi")),
        }
        for name, query in looked_for.items():
            taken_ms = 1e3 * best(REPEATS, lambda query=query: store.search_trials(query, 50, 200))
            found.append(
                Line(f"search in {count} trials, page of 50: {name}", "< 200 ms", f"{taken_ms:.1f} ms", taken_ms < 200)
            )
        return found


def plotting(folder: Path) -> list[Line]:
    """A long trial reduced for a plot, against reading all of it."""
    rows = signals(2_000_000)
    with Store.open(f"sqlite:///{folder / 'plot.sqlite'}") as store:
        writer = trial_of(store)
        append(writer, rows)
        found = []
        for what, channels, points in (
            ("one channel", ["position_rad"], 2000),
            ("10 channels, each to 2 000 points", None, 2000),
        ):
            taken_ms = 1e3 * best(
                REPEATS,
                lambda channels=channels, points=points: store.samples_reduced(writer.trial_id, channels, points),
            )
            found.append(Line(f"2 M rows to 2 000 points: {what}", "< 30 ms", f"{taken_ms:.1f} ms", taken_ms < 30))
        whole_ms = 1e3 * best(3, lambda: store.samples(writer.trial_id))
        return [*found, Line("  reading all of it instead", "", f"{whole_ms:.0f} ms", True)]


def beside_a_server() -> list[Line]:
    """PostgreSQL against SQLite, on a server of its own; `database_rates` prints more of it."""
    try:
        from tests.store.database_rates import advised_beside_sqlite
    except ImportError as missing:
        return [Line("PostgreSQL / SQLite", "", f"not measured: {missing}", True)]
    return advised_beside_sqlite()


def signals(count: int) -> np.ndarray:
    """Rows of 10 channels: time, and noisy waves with all digits, as sensors give them."""
    generator = np.random.default_rng(1)
    time_s = np.arange(count) * 1e-3
    waves = [np.sin(time_s / (1 + number)) + 1e-3 * generator.normal(size=count) for number in range(9)]
    return np.column_stack([time_s, *waves])


def best(times: int, call: Callable[[], object]) -> float:
    """The shortest of several runs [s]."""
    taken = []
    for _ in range(times):
        started_s = time.perf_counter()
        call()
        taken.append(time.perf_counter() - started_s)
    return min(taken)


def trial_of(store: Store) -> TrialWriter:
    experiment = store.begin_experiment("steps", {}, "simulated", {}, {"name": "paper"})
    return store.begin_trial(experiment, "a", "steps", {"load_kg": 0.1}, CHANNELS)


def append(writer: TrialWriter, rows: np.ndarray) -> None:
    for start in range(0, len(rows), APPENDED_ROWS):
        writer.append(rows[start : start + APPENDED_ROWS])


def row_per_sample(path: Path, rows: np.ndarray) -> None:
    """A table with a column per channel, as fast as SQLite takes it: one transaction, WAL."""
    path.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA synchronous = NORMAL")
        columns = ", ".join(f"{name} REAL" for name in CHANNELS)
        connection.execute(f"CREATE TABLE sample (trial_id INTEGER, {columns})")
        places = ", ".join("?" * (1 + len(CHANNELS)))
        values = ((1, *row) for row in rows.tolist())
        connection.executemany(f"INSERT INTO sample VALUES ({places})", values)


def export(path: Path, trial_id: int) -> tuple[int, int]:
    """Bytes that the command wrote, and the most memory that it had."""
    command = [sys.executable, "-c", MEASURED, "--store", str(path), "trial", str(trial_id), "--csv"]
    target = path.with_suffix(".csv")
    with target.open("wb") as file:
        process = subprocess.run(command, stdout=file, stderr=subprocess.PIPE, text=True, check=True)
    size = target.stat().st_size
    target.unlink()
    return size, int(process.stderr) * 1024


def to_csv(rows: np.ndarray, path: Path) -> None:
    import pandas

    pandas.DataFrame(rows, columns=list(CHANNELS)).to_csv(path, index=False)


def fill(store: Store, count: int) -> None:
    """Trials without samples, 1 000 to an experiment, every other experiment real."""
    for first in range(0, count, 1000):
        source = "real" if first // 1000 % 2 else "simulated"
        experiment = store.begin_experiment("steps", {}, source, {}, {"name": "paper"})
        numbers = range(first, min(first + 1000, count))
        with store._database.writing() as connection:
            connection.execute(insert(TRIAL), [trial(number, experiment) for number in numbers])
            conditions = [row for number in numbers for row in conditions_of(number)]
            connection.execute(insert(TRIAL_CONDITION), conditions)


def trial(number: int, experiment: int) -> dict[str, object]:
    return {
        "id": number + 1,
        "experiment_id": experiment,
        "name": f"trial {number}",
        "kind": ("steps", "load-sweep", "speed-sweep")[number % 3],
        "channels": list(CHANNELS),
        "rows": 0,
        "started_utc": now(),
        "outcome": "tripped" if number % 97 == 0 else "completed",
        "reason": "",
        "results": {"current_a": 0.25},
    }


def conditions_of(number: int) -> list[dict[str, object]]:
    values = {"load_kg": 0.01 * (number % 11), "repeat": float(number % 7)}
    rows = [{"key": key, "number": value, "text": None, "flag": None} for key, value in values.items()]
    rows.append({"key": "balanced", "number": None, "text": None, "flag": number % 2 == 0})
    rows.append({"key": "grease", "number": None, "text": f"NLGI {number % 3}", "flag": None})
    return [{"trial_id": number + 1, "position": position, **row} for position, row in enumerate(rows)]


if __name__ == "__main__":
    main()
