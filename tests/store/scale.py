"""What a laboratory of many benches costs its database: `python -m tests.store.scale`.

Unit costs are measured on one bench and one PostgreSQL server (settings of docs/explanation/store.md), then multiplied:
what share of one server a thousand benches with 10^9 rows a day would take. Shares of time are by the clock, of a
machine that should have nothing else to do; the largest share breaks first.
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from sqlalchemy import insert, text

from bench.runs.lab_link import PERIOD_S
from bench.store import Store
from bench.store.schema import HANDED_IN
from bench.store.tables.benches import BenchWord
from bench.store.tables.experiments import now
from tests.databases import postgresql_server
from tests.lab.line import Line, print_table
from tests.store.database_rates import ADVISED
from tests.store.rates import append, signals, trial_of

DAY_S = 86_400.0
CONNECTIONS = 100  # of a server as it is installed
LONG_ROWS, SMALL, TELLS, KNOWN = 1_000_000, 20, 200, 20_000


def main() -> None:
    """Measure, multiply, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--benches", type=int, default=1000)
    parser.add_argument("--rows-a-day", type=float, default=1e9)
    parser.add_argument("--rows-an-experiment", type=float, default=30_000.0)
    parser.add_argument("--disk-tb", type=float, default=10.0)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="friction-bench-scale-") as folder, postgresql_server(ADVISED) as server:
        lab_url = server.url(server.create())
        with Store.open(f"sqlite:///{Path(folder) / 'own.sqlite'}") as own, Store.open(lab_url) as lab:
            print_table(_lines(own, lab, asked))


def _lines(own: Store, lab: Store, asked: argparse.Namespace) -> list[Line]:
    before = lab._database.backend.size_bytes()
    row_s = _handing_in_s(own, lab, [LONG_ROWS]) / LONG_ROWS
    row_bytes = (lab._database.backend.size_bytes() - before) / LONG_ROWS
    experiment_s = _handing_in_s(own, lab, [100] * SMALL) / SMALL
    tell_s = _each_s(lambda: lab.benches.tell(BenchWord("bench 1", "here", "running")), TELLS)
    with lab._database.reading() as connection:
        mine = text("SELECT count(*) FROM pg_stat_activity WHERE datname = current_database()")
        connections = int(connection.execute(mine).scalar_one())
    _know(lab, KNOWN)
    known_s = _each_s(lambda: own.hand_in_to(lab, "bench 1").waiting(), 5) / KNOWN
    experiments = asked.rows_a_day / asked.rows_an_experiment
    full_days = asked.disk_tb * 1e12 / (asked.rows_a_day * row_bytes)
    asks = asked.benches * DAY_S / PERIOD_S
    per_bench = experiments / asked.benches * 365.0
    return [
        _share("a row of a long recording", f"{1e6 * row_s:.2f} us", asked.rows_a_day * row_s / DAY_S),
        _share("an experiment of 100 rows", f"{1e3 * experiment_s:.1f} ms", experiments * experiment_s / DAY_S),
        _share("a bench tells what it does", f"{1e3 * tell_s:.1f} ms", asks * tell_s / DAY_S),
        _share(
            f"once a day it asks what is there, of a year ({per_bench:.0f} experiments)",
            f"{1e6 * known_s:.2f} us each",
            asked.benches * per_bench * known_s / DAY_S,
        ),
        _share("connections of a bench", f"{connections}", asked.benches * connections / CONNECTIONS),
        Line(f"a disk of {asked.disk_tb:g} TB is full", "", f"{row_bytes:.0f} B a row, {full_days:.0f} days", True),
    ]


def _share(what: str, unit: str, share: float) -> Line:
    return Line(what, "<= 1 server", f"{unit}; {share:.2g} of a server", share <= 1.0)


def _handing_in_s(own: Store, lab: Store, sizes: list[int]) -> float:
    """Seconds for experiments of so many rows of all recorded channels."""
    hand = own.hand_in_to(lab, "bench 1")
    for rows in sizes:
        writer = trial_of(own)
        append(writer, signals(rows))
        writer.finish("completed")
        own.finish_experiment(own.trial(writer.trial_id).experiment_id, "completed")
    began_s = time.perf_counter()
    for experiment_id in hand.waiting():
        hand.hand_in(experiment_id)
    return time.perf_counter() - began_s


def _know(lab: Store, count: int) -> None:
    """Experiments that a bench handed in earlier."""
    common = {"bench": "bench 1", "started_utc": now(), "experiment_id": 1, "complete": True}
    with lab._database.writing() as connection:
        connection.execute(insert(HANDED_IN), [{**common, "origin_id": 10_000 + number} for number in range(count)])


def _each_s(work: Callable[[], object], times: int) -> float:
    taken = []
    for _ in range(times):
        began_s = time.perf_counter()
        work()
        taken.append(time.perf_counter() - began_s)
    return float(np.median(taken))


if __name__ == "__main__":
    main()
