"""PostgreSQL beside SQLite, the same blocks through the same store: `python -m tests.store.database_rates`.

Both write in turn. Of time by the clock the median of the ratios is told, with the smallest and the largest: it means
little on a busy machine, where the server's processes wait for their turn. CPU time says what the work costs: of this
process, and of all processes of the server with the checkpoint of what was written, as SQLite makes its own. A ratio is
only worth something where both promise the same:

- a killed process loses nothing that was committed, a power cut may cost the last commits: SQLite as the store uses it
  (WAL, synchronous = NORMAL), PostgreSQL with synchronous_commit = off;
- no power cut costs a commit: synchronous = FULL, and synchronous_commit = on.

fsync is on in both. The server is in the state of one that has run for a while: its memory was written to before, and
so were the files of its log. The last lines of each server are bounds: blocks made before, alone, without the store.
"""

import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import psycopg
import pytest
from sqlalchemy import event

from bench.store import Store
from bench.store.tables.samples import BLOCK_ROWS, columns_of, encode
from compensator.lab.recordings.recording import FloatArray
from tests.databases import PostgresqlServer, postgresql_server
from tests.lab.line import Line, print_table
from tests.store.rates import APPENDED_ROWS, append, signals, trial_of

ROUNDS, ROWS = 9, 500_000
WARM_ROUNDS = 25  # 1 GB, as much as the server has for its buffers
ASKED = 0.7
# docs/explanation/store.md says them, and why
ADVISED = {"shared_buffers": "1GB", "max_wal_size": "8GB"}
SERVERS: dict[str, dict[str, str]] = {"settings of docs/explanation/store.md": ADVISED, "settings as installed": {}}
PROMISES = {"killed": ("NORMAL", "off"), "power cut": ("FULL", "on")}
Blocks = list[tuple[int, int, int, bytes]]
BY_COPY = "COPY plain (number, first_row, rows, data) FROM STDIN (FORMAT BINARY)"
BY_INSERT = "INSERT INTO plain (number, first_row, rows, data) VALUES (%b, %b, %b, %b)"


def main() -> None:
    """Measure every pair, and print it."""
    rows = signals(ROWS)
    print_table([line for name, settings in SERVERS.items() for line in beside_sqlite(name, settings, rows)])


def advised_beside_sqlite() -> list[Line]:
    """The lines of a server with the settings of the documents; where no server is found, a line that says so."""
    try:
        return list(beside_sqlite("PostgreSQL, " + next(iter(SERVERS)), ADVISED, signals(ROWS)))
    except pytest.skip.Exception as missing:
        return [Line("PostgreSQL / SQLite", f">= {ASKED}", f"not measured: {missing}", True)]


def beside_sqlite(name: str, settings: dict[str, str], rows: FloatArray) -> Iterator[Line]:
    """One server, by both promises, and its bound."""
    with tempfile.TemporaryDirectory(prefix="friction-bench-rates-") as folder, postgresql_server(settings) as server:
        yield Line(name, "", "", True)
        with Store.open(server.url(server.create())) as store:
            in_turn(server, lambda: append(trial_of(store), rows), rounds=WARM_ROUNDS)
        for promise, (file_syncs, server_syncs) in PROMISES.items():
            url = f"{server.url(server.create())}&options=-csynchronous_commit%3D{server_syncs}"
            with Store.open(f"sqlite:///{Path(folder) / promise}.sqlite") as file, Store.open(url) as other:
                _use(file, file_syncs)
                pair = [lambda store=store: append(trial_of(store), rows) for store in (other, file)]
                yield _line(f"  {promise}: PostgreSQL / SQLite", in_turn(server, *pair), asked=bool(settings))
        with Store.open(f"sqlite:///{Path(folder) / 'bound'}.sqlite") as file:
            for what, send in (("INSERT", _insert), ("COPY BINARY", _copy)):
                pair = [_bare(server, rows, send), lambda: append(trial_of(file), rows)]
                yield _line(f"  bound, {what} alone / SQLite", in_turn(server, *pair), asked=False)


class Taken(NamedTuple):
    """What one round took, by the clock and of the processors, here and of the server's processes [s]."""

    wall_s: float
    client_s: float
    server_s: float

    @property
    def cpu_s(self) -> float:
        return self.client_s + self.server_s


def in_turn(server: PostgresqlServer, *works: Callable[[], object], rounds: int = ROUNDS) -> list[list[Taken]]:
    """What each takes, round for round; a first round does not count."""
    return [[_taken(server, work) for work in works] for _ in range(rounds + 1)][1:]


def _taken(server: PostgresqlServer, work: Callable[[], object]) -> Taken:
    began_s, client_s, server_s = time.perf_counter(), time.process_time(), server.cpu_s()
    work()
    wall_s, client_s = time.perf_counter() - began_s, time.process_time() - client_s
    server.run("CHECKPOINT")
    return Taken(wall_s, client_s, server.cpu_s() - server_s)


def _line(what: str, rounds: list[list[Taken]], *, asked: bool) -> Line:
    ratios = [file.wall_s / ours.wall_s for ours, file in rounds]
    by_cpu = [file.cpu_s / ours.cpu_s for ours, file in rounds]
    rates = [ROWS / 1e6 / statistics.median(one[index].wall_s for one in rounds) for index in (0, 1)]
    told = (
        f"{_spread(ratios)}, {rates[0]:.2f} against {rates[1]:.2f} M rows/s; by CPU {_spread(by_cpu)}, {_cpu(rounds)}"
    )
    return Line(what, f">= {ASKED}" if asked else "", told, statistics.median(ratios) >= ASKED or not asked)


def _cpu(rounds: list[list[Taken]]) -> str:
    client_s, server_s = (statistics.median(getattr(ours, name) for ours, _ in rounds) for name in Taken._fields[1:])
    file_s = statistics.median(file.cpu_s for _, file in rounds)
    return f"{1e3 * client_s:.0f} ms + server {1e3 * server_s:.0f} against {1e3 * file_s:.0f}"


def _spread(values: list[float]) -> str:
    return f"{statistics.median(values):.2f} ({min(values):.2f} .. {max(values):.2f})"


def _use(store: Store, syncs: str) -> None:
    engine = store._database.backend.engine
    engine.dispose()
    event.listen(engine.pool, "connect", lambda raw, _: raw.execute(f"PRAGMA synchronous = {syncs}") and None)


def _bare(
    server: PostgresqlServer, rows: FloatArray, send: Callable[[psycopg.Cursor, Blocks], None]
) -> Callable[[], None]:
    blocks = [encode(columns_of(rows[first : first + BLOCK_ROWS])) for first in range(0, len(rows), BLOCK_ROWS)]
    connection = psycopg.connect(f"{server.url(server.create())}&options=-csynchronous_commit%3Doff")
    connection.execute(
        "CREATE TABLE plain (number int, first_row int, rows int, data bytea, PRIMARY KEY (number, first_row))"
    )
    connection.execute("ALTER TABLE plain ALTER COLUMN data SET STORAGE EXTERNAL")
    connection.commit()
    number = iter(range(10 * ROUNDS))

    def write() -> None:
        turn, share = next(number), APPENDED_ROWS // BLOCK_ROWS
        for first in range(0, len(blocks), share):
            places = enumerate(blocks[first : first + share], first)
            with connection.cursor() as cursor:
                send(cursor, [(turn, place, BLOCK_ROWS, block) for place, block in places])
            connection.commit()

    return write


def _copy(cursor: psycopg.Cursor, blocks: Blocks) -> None:
    with cursor.copy(BY_COPY) as target:
        target.set_types(["int4", "int4", "int4", "bytea"])
        for block in blocks:
            target.write_row(block)


def _insert(cursor: psycopg.Cursor, blocks: Blocks) -> None:
    with cursor.connection.pipeline():
        for block in blocks:
            cursor.execute(BY_INSERT, block)


if __name__ == "__main__":
    main()
