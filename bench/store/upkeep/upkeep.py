"""Looking after a store: what is in it, is it sound, a copy of it, its space given back."""

import sqlite3
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from sqlalchemy import Connection, Table, func, insert, select, text
from sqlalchemy.exc import SQLAlchemyError

from bench.store.address import database_of
from bench.store.database import Database
from bench.store.errors import StoreFileError, StoreFullError, StoreStateError
from bench.store.migration import HEAD, migrate
from bench.store.schema import EXPERIMENT, METADATA, SAMPLE_BLOCK, STUDY, TRIAL
from bench.store.sqlite import Sqlite, explain
from bench.store.tables.chain import head
from bench.store.tables.experiments import unfinished
from bench.store.tables.samples import SAMPLE_BYTES, damaged_blocks
from bench.store.upkeep.chain_check import broken_chain

ROWS_AT_ONCE = 64


def sqlite_copy(database: Database, path: Path) -> None:
    """Copy into a file that is not there yet: all of it appears, or nothing.

    Raises:
        StoreFileError: the file is there, or its folder is not.
        StoreFullError: there is no room for it.
    """
    if path.exists():
        raise StoreFileError(f"backup '{path}' is there already; name another file, or remove it")
    if not path.parent.is_dir():
        raise StoreFileError(f"backup '{path}': folder {path.parent} does not exist; create it, or name another")
    unfinished = path.with_name(f".{path.name}.part")
    try:
        if isinstance(database.backend, Sqlite):
            _copy_file(database.backend.path, unfinished)
        else:
            copy_into(database, f"sqlite:///{unfinished}")
        _make_one_file(unfinished)
        unfinished.rename(path)
    except sqlite3.Error as error:
        raise explain(error, path, database.busy_timeout_s) or error from error
    except OSError as error:
        if isinstance(error, (StoreFileError, StoreFullError)):
            raise
        raise StoreFileError(f"backup '{path}' cannot be written: {error.strerror or error}") from error
    finally:
        for ending in ("", "-wal", "-shm", "-journal"):
            unfinished.with_name(unfinished.name + ending).unlink(missing_ok=True)


def copy_into(database: Database, url: str) -> None:
    """Copy into an empty database of any kind, in one transaction.

    Raises:
        StoreFileError: it is not empty.
    """
    target = database_of(url, database.busy_timeout_s)
    try:
        migrate(target)
        with database.reading() as read, target.writing() as write:
            if write.execute(select(EXPERIMENT.c.id).limit(1)).first() is not None:
                raise StoreFileError(f"backup '{target.where}' holds experiments already; name an empty database")
            for table in METADATA.sorted_tables:
                _copy_rows(read, write, table)
    finally:
        target.close()


def _copy_rows(read: Connection, write: Connection, table: Table) -> None:
    order = table.primary_key.columns
    found = read.execute(select(table).order_by(*order), execution_options={"yield_per": ROWS_AT_ONCE})
    for part in found.mappings().partitions(ROWS_AT_ONCE):
        write.execute(insert(table), [dict(row) for row in part])
    if write.dialect.name == "postgresql" and "id" in table.c:  # else the next row would be given a number again
        sequence = f"SELECT setval(pg_get_serial_sequence('{table.name}', 'id'), max(id)) FROM {table.name}"  # noqa: S608
        write.execute(text(sequence))


def _copy_file(source: Path, target: Path) -> None:
    target.unlink(missing_ok=True)
    with closing(sqlite3.connect(source)) as read, closing(sqlite3.connect(target)) as write:
        read.backup(write)  # in one step: readers do not block writers, and the copy is of one moment


def _make_one_file(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA journal_mode = DELETE")
        (found,) = connection.execute("PRAGMA integrity_check").fetchone()
    if found != "ok":
        raise StoreFileError(f"backup '{path}' is not sound: {found}; check the store and the disk")


@dataclass(frozen=True, slots=True)
class StoreInfo:
    """What is in a store.

    Attributes:
        where: the database; without password.
        size_bytes: of the database, with its log.
        free_bytes: on its disk; None where that is another machine's.
        oldest_utc: when the first of its experiments began.
        chain_entries: of the hash chain over its records.
        chain_head: its newest link. Noted elsewhere, `check` tells by it whether the end of the chain was cut off.
    """

    where: str
    schema: str
    size_bytes: int
    free_bytes: int | None
    experiments: int
    trials: int
    rows: int
    studies: int
    running: int
    oldest_utc: datetime | None
    chain_entries: int
    chain_head: str


class Upkeep:
    """`Store.upkeep`."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def info(self) -> StoreInfo:
        """What is in the store."""
        with self._database.reading() as connection:
            count = select(func.count()).select_from
            running = len(unfinished(connection))
            experiments, oldest = connection.execute(select(func.count(), func.min(EXPERIMENT.c.started_utc))).one()
            trials, rows = connection.execute(select(func.count(), func.coalesce(func.sum(TRIAL.c.rows), 0))).one()
            studies = connection.execute(count(STUDY)).scalar_one()
            length, newest = head(connection)
        backend = self._database.backend
        size, free = backend.size_bytes(), backend.free_bytes()
        return StoreInfo(
            self._database.where,
            HEAD,
            size,
            free,
            experiments,
            trials,
            int(rows),
            studies,
            running,
            oldest,
            length,
            newest,
        )

    def check(self, chain_head: str | None = None) -> list[str]:
        """Read all of it, and say what is wrong; nothing is an empty list.

        Args:
            chain_head: as `info` told it at another time, kept elsewhere: the chain has to hold it still.
        """
        looks = (self._incomplete_trials, self._damaged_blocks, lambda: self._broken_chain(chain_head))
        problems = self._database.backend.check()
        for look in looks:
            try:
                problems += look()
            except (StoreFileError, ValueError, TypeError, SQLAlchemyError) as error:
                problems.append(f"the store cannot be read to its end: {error}")
        return problems

    def backup(self, target: str) -> None:
        """Copy the store while it is in use: what was committed when the copy began.

        Args:
            target: a file to make, or the URL of an empty database.

        Raises:
            StoreFileError: it is there already, or is not empty.
            StoreFullError: there is no room for the file.
        """
        if "://" in target:
            copy_into(self._database, target)
        else:
            sqlite_copy(self._database, Path(target).absolute())

    def vacuum(self) -> int:
        """Give the space of what was removed back to the disk, and renew what queries are planned by.

        Returns:
            How many bytes smaller the database is.

        Raises:
            StoreStateError: something is recorded or imported.
            StoreFullError: SQLite needs room for a copy while it works.
        """
        self._refuse_while_in_use()
        before = self._database.backend.size_bytes()
        free = self._database.backend.free_bytes()
        if free is not None and free < before:
            raise StoreFullError(
                f"store '{self._database.where}': {free / 1e6:.0f} MB are free on its disk; to vacuum it needs as much "
                f"as it has, {before / 1e6:.0f} MB. Free some space first"
            )
        with self._database.explained():
            self._database.backend.vacuum()
        return before - self._database.backend.size_bytes()

    def _refuse_while_in_use(self) -> None:
        with self._database.reading() as connection:
            found = unfinished(connection)
        alive = [str(number) for number, token, _ in found if self._database.backend.lives(token)]
        if alive:
            raise StoreStateError(f"experiment {', '.join(alive)} is being recorded or imported; wait for its end")

    def _damaged_blocks(self) -> list[str]:
        """Blocks whose checksum says that they are not what was written."""
        with self._database.reading() as connection:
            return [
                f"trial {trial}: its {what} of rows {first} .. {first + rows - 1} are not what was written (checksum); "
                "restore them from a backup, or save the rest: friction-bench store repair"
                for what, trial, first, rows in damaged_blocks(connection)
            ]

    def _broken_chain(self, chain_head: str | None) -> list[str]:
        with self._database.reading() as connection:
            return broken_chain(connection, chain_head)

    def _incomplete_trials(self) -> list[str]:
        """Trials whose blocks do not make up their rows."""
        blocks = (
            select(
                SAMPLE_BLOCK.c.trial_id,
                func.sum(SAMPLE_BLOCK.c.rows).label("rows"),
                func.max(SAMPLE_BLOCK.c.first_row + SAMPLE_BLOCK.c.rows).label("last"),
                func.sum(func.length(SAMPLE_BLOCK.c.data)).label("bytes"),
            )
            .group_by(SAMPLE_BLOCK.c.trial_id)
            .subquery()
        )
        query = select(TRIAL.c.id, TRIAL.c.rows, TRIAL.c.channels, blocks.c.rows, blocks.c.last, blocks.c.bytes)
        problems = []
        with self._database.reading() as connection:
            for number, rows, channels, *found in connection.execute(query.join(blocks, isouter=True)):
                present, last, size = (int(value or 0) for value in found)
                if (present, last, size) != (rows, rows, rows * len(channels) * SAMPLE_BYTES):
                    problems.append(f"trial {number} has {rows} rows; its blocks hold {present}, in {size} bytes")
        return problems
