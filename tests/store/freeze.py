"""Writes what this version's store makes as SQL text: `python -m tests.store.freeze`.

Run it once for each released schema, before the next migration is written, and keep the file: the tests upgrade
every one of them. A file that is there is never changed.
"""

import sqlite3
import sys
import tempfile
from contextlib import closing
from pathlib import Path

import numpy as np

from bench.store import Store
from bench.store.migration import HEAD

RELEASED = Path(__file__).parent / "released"
CHANNELS = ("time_s", "position_rad", "duty")
PROVENANCE = {
    "software": {"version": "0.1.0", "commit": "f00d"},
    "configuration": {"name": "bench 3"},
    "drive": {"product": "simulated drive", "firmware": "1.2"},
    "seed": 7,
}


def fill(store: Store) -> None:
    """A completed experiment, one that was left running, an import, a study with two models."""
    steps = store.begin_experiment("steps", {"repeats": 2}, "simulated", PROVENANCE, {"name": "paper"}, "Ada", "grüße")
    for repeat in (1, 2):
        conditions = {"load_kg": 0.1, "balanced": False, "grease": "NLGI 2", "repeat": repeat}
        writer = store.begin_trial(steps, f"step {repeat}", "steps", conditions, CHANNELS)
        for block in range(3):
            writer.append(rows(40 * block, 40), [(0.5, "breakaway", "up")] if block == 0 else [])
        writer.finish("completed", "", {"current_a": 0.25})
    store.finish_experiment(steps, "completed", "", {"spread_a": None})
    running = store.begin_experiment("load-sweep", {}, "real", {}, {"name": "paper"})
    store.begin_trial(running, "0 g", "load-sweep", {"load_kg": 0.0}, CHANNELS).append(rows(0, 5))
    study = store.create_study("gear 12", {"trial_ids": [1], "held_out": [False]})
    base = store.add_model(study, None, ["coulomb"], {"error": 0.25})
    store.add_model(study, base, ["coulomb", "inertia"], {"error": 0.125})


def rows(first: int, count: int) -> np.ndarray:
    time_s = np.arange(first, first + count) / 64
    return np.column_stack([time_s, np.sin(time_s), np.full(count, np.nan)])


def main() -> None:
    """Write the file of the schema that this version makes."""
    target = RELEASED / f"{HEAD}.sql"
    if target.exists():
        sys.exit(f"{target} is there already: what is released does not change")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.sqlite"
        with Store.open(f"sqlite:///{path}") as store:
            fill(store)
            with closing(sqlite3.connect(path)) as connection:
                target.write_text("\n".join(connection.iterdump()) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
