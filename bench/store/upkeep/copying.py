"""A copy of a store, made while it is in use: into a file, or into another database."""

import sqlite3
from contextlib import closing
from pathlib import Path

from sqlalchemy import Connection, Table, insert, select, text

from bench.store.address import database_of
from bench.store.database import Database
from bench.store.errors import StoreFileError, StoreFullError
from bench.store.migration import migrate
from bench.store.schema import EXPERIMENT, METADATA
from bench.store.sqlite import Sqlite, explain

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
