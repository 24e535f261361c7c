"""PostgreSQL beside SQLite, the same blocks through the same store: `python -m tests.store.database_rates`.

Both write in turn. Of time by the clock the median of the ratios is told, with the smallest and the largest: it means
little on a busy machine, where the server's processes wait for their turn. CPU time, which is that of all processes
of the server too, says what the work costs. A ratio is only worth something where both promise the same:

- a killed process loses nothing that was committed, a power cut may cost the last commits: SQLite as the store uses it
  (WAL, synchronous = NORMAL), PostgreSQL with synchronous_commit = off;
- no power cut costs a commit: synchronous = FULL, and synchronous_commit = on.

fsync is on in both. The last line of each server is the bound: the blocks alone by COPY BINARY, without the store.
"""

import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import psycopg
from sqlalchemy import event

from bench.store import Store
from bench.store.tables.samples import BLOCK_ROWS, columns_of, encode
from compensator.lab.recordings.recording import FloatArray
from tests.databases import PostgresqlServer, postgresql_server
from tests.lab.line import Line, print_table
from tests.store.rates import APPENDED_ROWS, append, signals, trial_of

ROUNDS, ROWS = 9, 500_000
ASKED = 0.7
# docs/explanation/store.md says them, and why
ADVISED = {"shared_buffers": "1GB", "wal_buffers": "64MB", "max_wal_size": "8GB"}
SERVERS: dict[str, dict[str, str]] = {"settings of docs/explanation/store.md": ADVISED, "settings as installed": {}}
PROMISES = {"killed": ("NORMAL", "off"), "power cut": ("FULL", "on")}
BY_COPY = "COPY plain (number, first_row, rows, data) FROM STDIN (FORMAT BINARY)"


def main() -> None:
    """Measure every pair, and print it."""
    rows = signals(ROWS)
    print_table([line for name, settings in SERVERS.items() for line in beside_sqlite(name, settings, rows)])


def beside_sqlite(name: str, settings: dict[str, str], rows: FloatArray) -> Iterator[Line]:
    """One server, by both promises, and its bound."""
    with tempfile.TemporaryDirectory(prefix="friction-bench-rates-") as folder, postgresql_server(settings) as server:
        yield Line(name, "", "", True)
        for promise, (file_syncs, server_syncs) in PROMISES.items():
            url = f"{server.url(server.create())}&options=-csynchronous_commit%3D{server_syncs}"
            with Store.open(f"sqlite:///{Path(folder) / promise}.sqlite") as file, Store.open(url) as other:
                _use(file, file_syncs)
                pair = [lambda store=store: append(trial_of(store), rows) for store in (other, file)]
                yield _line(f"  {promise}: PostgreSQL / SQLite", in_turn(server, *pair), asked=bool(settings))
        with Store.open(f"sqlite:///{Path(folder) / 'bound'}.sqlite") as file:
            found = in_turn(server, _copying(server, rows), lambda: append(trial_of(file), rows))
            yield _line("  bound, COPY BINARY alone / SQLite", found, asked=False)


class Taken(NamedTuple):
    """What one round took, by the clock and of the processors, the server's processes among them [s]."""

    wall_s: float
    cpu_s: float


def in_turn(server: PostgresqlServer, *works: Callable[[], object]) -> list[list[Taken]]:
    """What each takes, round for round; a first round does not count."""
    rounds = [[_taken(server, work) for work in works] for _ in range(ROUNDS + 1)]
    return rounds[1:]


def _taken(server: PostgresqlServer, work: Callable[[], object]) -> Taken:
    began_s, began_cpu_s = time.perf_counter(), time.process_time() + server.cpu_s()
    work()
    return Taken(time.perf_counter() - began_s, time.process_time() + server.cpu_s() - began_cpu_s)


def _line(what: str, rounds: list[list[Taken]], *, asked: bool) -> Line:
    ratios = [file.wall_s / ours.wall_s for ours, file in rounds]
    by_cpu = [file.cpu_s / ours.cpu_s for ours, file in rounds]
    rates = [ROWS / 1e6 / statistics.median(one[index].wall_s for one in rounds) for index in (0, 1)]
    told = f"{_spread(ratios)}, {rates[0]:.2f} against {rates[1]:.2f} M rows/s; by CPU {_spread(by_cpu)}"
    return Line(what, f">= {ASKED}" if asked else "", told, statistics.median(ratios) >= ASKED or not asked)


def _spread(values: list[float]) -> str:
    return f"{statistics.median(values):.2f} ({min(values):.2f} .. {max(values):.2f})"


def _use(store: Store, syncs: str) -> None:
    engine = store._database.backend.engine
    engine.dispose()
    event.listen(engine.pool, "connect", lambda raw, _: raw.execute(f"PRAGMA synchronous = {syncs}") and None)


def _copying(server: PostgresqlServer, rows: FloatArray) -> Callable[[], None]:
    blocks = [encode(columns_of(rows[first : first + BLOCK_ROWS])) for first in range(0, len(rows), BLOCK_ROWS)]
    connection = psycopg.connect(f"{server.url(server.create())}&options=-csynchronous_commit%3Doff")
    connection.execute(
        "CREATE TABLE plain (number int, first_row int, rows int, data bytea, PRIMARY KEY (number, first_row))"
    )
    connection.execute("ALTER TABLE plain ALTER COLUMN data SET STORAGE EXTERNAL")
    connection.commit()
    number = iter(range(10 * ROUNDS))

    def copy() -> None:
        turn, share = next(number), APPENDED_ROWS // BLOCK_ROWS
        for first in range(0, len(blocks), share):
            with connection.cursor() as cursor, cursor.copy(BY_COPY) as target:
                target.set_types(["int4", "int4", "int4", "bytea"])
                for place, block in enumerate(blocks[first : first + share], first):
                    target.write_row((turn, place, BLOCK_ROWS, block))
            connection.commit()

    return copy


if __name__ == "__main__":
    main()
