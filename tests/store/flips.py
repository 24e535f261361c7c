"""Does `friction-bench store check` find flipped bits: `python -m tests.store.flips 1000 [SEED]`.

A bit anywhere in the file of a store is flipped. Where that changes a record, or lets none be read, the command is
asked.
Elsewhere (unused space, the queue) it is no error, and another bit is drawn.
"""

import random
import sqlite3
import sys
import tempfile
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from sqlalchemy import select
from typer.testing import CliRunner

from bench.cli.app import app
from bench.store import Store
from bench.store.address import database_of
from bench.store.schema import CHAIN, METADATA, SAMPLE_OVERVIEW
from bench.store.tables.audit import AuditEntry
from bench.store.tables.chain import SUBJECTS
from bench.store.tables.experiments import now
from tests.store.freeze import fill

RECORDS = sorted(
    {CHAIN.name, SAMPLE_OVERVIEW.name}
    | {subject.table.name for subject in SUBJECTS.values()}
    | {table.name for subject in SUBJECTS.values() for table, _, _ in subject.parts}
)


def filled(path: Path) -> None:
    """A store that has a few of each record."""
    with Store.open(f"sqlite:///{path}") as store:
        fill(store)
        store.annotate(1, tags=["winter", "new grease"])
        store.calibrations.add(
            note="arm", source="real", rig={"name": "paper"}, drive={}, provenance={}, experiment_ids=[1],
            trial_ids=[1], result={"friction_a": [0.1, 0.2]},
        )  # fmt: skip
        store.access.tokens.add("ada", "admin", "d" * 64)
        store.access.audit.add([AuditEntry(now(), "ada", "admin", "::1", "POST", f"/{n}", 200, "") for n in range(20)])


def records(path: Path) -> list[object]:
    """Every record as SQLite reads it; what cannot be read is an error as text."""
    found: list[object] = []
    with closing(sqlite3.connect(path)) as connection:
        for table in RECORDS:
            try:
                found.append(connection.execute(f"SELECT * FROM {table} ORDER BY 1, 2").fetchall())
            except (sqlite3.Error, UnicodeDecodeError) as error:
                found.append(str(error))
    return found


def values(path: Path) -> list[object]:
    """Every record as the store reads it."""
    database = database_of(f"sqlite:///{path}", 1.0)
    with database.reading() as connection:
        found: list[object] = [connection.execute(select(METADATA.tables[name])).all() for name in RECORDS]
    database.close()
    return found


def is_found(path: Path) -> bool:
    """Whether the command says that something is wrong, in words and not by a traceback."""
    done = CliRunner().invoke(app, ["--store", str(path), "store", "check"])
    if not isinstance(done.exception, SystemExit | None):
        print(f"traceback: {done.exception!r}")
        return False
    return done.exit_code != 0


def flipped(sound: bytes, seed: int) -> Iterator[tuple[int, bytes]]:
    """Copies of a file with one flipped bit each, and which bit it is."""
    drawn = random.Random(seed)
    while True:
        bit = drawn.randrange(8 * len(sound))
        spoilt = bytearray(sound)
        spoilt[bit // 8] ^= 1 << bit % 8
        yield bit, bytes(spoilt)


def count(flips: int, seed: int, folder: Path) -> tuple[int, int, list[int]]:
    """How many flips that matter were found, how many were harmless, and the bits that were missed."""
    path = folder / "bench.sqlite"
    filled(path)
    assert not is_found(path)
    sound, before = path.read_bytes(), records(path)
    sound_path = folder / "sound.sqlite"
    sound_path.write_bytes(sound)
    found, harmless, missed = 0, 0, []
    for bit, spoilt in flipped(sound, seed):
        for ending in ("-wal", "-shm"):
            path.with_name(path.name + ending).unlink(missing_ok=True)
        path.write_bytes(spoilt)
        if records(path) == before:
            harmless += 1
        elif is_found(path):
            found += 1
        elif values(path) == values(sound_path):
            harmless += 1  # another sign between the numbers of a date: it is read as before
        else:
            missed.append(bit)
        if found + len(missed) == flips:
            return found, harmless, missed
    raise AssertionError


def main() -> None:
    """Print the count; exit code 1 where a flip was missed."""
    words = [int(word) for word in sys.argv[1:]]
    flips, seed = [*words, *[1000, 1][len(words) :]]
    with tempfile.TemporaryDirectory() as folder:
        found, harmless, missed = count(flips, seed, Path(folder))
    print(f"flipped bits found: {found} of {flips}; {harmless} more changed nothing that is read of a record")
    if missed:
        sys.exit(f"missed: bits {missed}")


if __name__ == "__main__":
    main()
