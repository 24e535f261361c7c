"""SQLite: all that is special about it. Other databases get a module of their own.

WAL lets readers go on while one writer writes, and with synchronous = NORMAL what was committed
survives the death of the process (a power cut may cost the last commits, never the database).
Transactions that write take the write lock when they begin, so that the busy time-out applies:
SQLite does not wait when a reading transaction turns into a writing one.
"""

import sqlite3
from pathlib import Path

from sqlalchemy import Connection, Engine, Pool, create_engine, event
from sqlalchemy.engine import URL
from sqlalchemy.pool import ConnectionPoolEntry

from bench.store.errors import (
    StoreError,
    StoreFileError,
    StoreFullError,
    StoreLockedError,
    StoreReadOnlyError,
)
from bench.store.json_text import to_json

WAL_LIMIT_BYTES = 64 * 2**20  # the log is cut back to this after a large import
WRITES = "writes"  # execution option of connections that are going to write


def file_of(url: URL) -> Path:
    """The database file that a URL names, absolute.

    Raises:
        StoreFileError: the URL names no file, or its folder does not exist.
    """
    if not url.database or url.database == ":memory:" or url.database.startswith("file:"):
        raise StoreFileError(f"store '{url}' names no file; write sqlite:///bench.sqlite")
    path = Path(url.database).expanduser().absolute()
    if not path.parent.is_dir():
        raise StoreFileError(f"store '{path}': folder {path.parent} does not exist; create it, or name another")
    if path.is_dir():
        raise StoreFileError(f"store '{path}' is a folder; name a file in it")
    return path


def create(path: Path, busy_timeout_s: float) -> Engine:
    """An engine for a database file; connections are made as they are needed."""
    engine = create_engine(
        URL.create("sqlite", database=str(path)),
        connect_args={"timeout": busy_timeout_s},  # set as the connection opens: before any statement can meet a lock
        max_overflow=-1,
        json_serializer=to_json,
    )
    event.listen(engine.pool, "connect", _prepare)
    event.listen(engine, "begin", _begin)
    return engine


def _prepare(connection: sqlite3.Connection, record: ConnectionPoolEntry | Pool) -> None:  # noqa: ARG001
    connection.isolation_level = None  # transactions are begun by _begin, not by Python's module
    connection.execute("PRAGMA journal_mode = WAL")
    connection.execute("PRAGMA synchronous = NORMAL")
    connection.execute("PRAGMA foreign_keys = ON")
    connection.execute(f"PRAGMA journal_size_limit = {WAL_LIMIT_BYTES}")


def _begin(connection: Connection) -> None:
    writes = connection.get_execution_options().get(WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def explain(error: BaseException | None, path: Path, busy_timeout_s: float) -> StoreError | None:
    """The store's error for an error of SQLite, with the next step; None where it is none of these."""
    if not isinstance(error, sqlite3.Error):
        return None
    name = getattr(error, "sqlite_errorname", None) or ""
    where = f"store '{path}'"
    if name.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")):
        return StoreLockedError(
            f"{where} is locked by another process for more than {busy_timeout_s:g} s; "
            "close the program that holds it open (an SQLite browser, a backup), then try again"
        )
    if name.startswith("SQLITE_FULL"):
        return StoreFullError(f"{where}: the disk is full; free some space, then start again. Earlier blocks are kept")
    if name.startswith("SQLITE_READONLY"):
        return StoreReadOnlyError(f"{where} is read-only; make the file and its folder writable, or name another file")
    if name.startswith("SQLITE_CANTOPEN"):
        return StoreReadOnlyError(f"{where} cannot be opened or created; make its folder readable and writable")
    if name.startswith("SQLITE_NOTADB"):
        return StoreFileError(f"{where} is not an SQLite database; name another file")
    if name.startswith("SQLITE_CORRUPT"):
        return StoreFileError(f"{where} is damaged ({error}); restore a copy, or move it away and start a new one")
    if name.startswith("SQLITE_IOERR"):
        return StoreFileError(
            f"{where}: the disk reports an error ({name}: {error}); check the disk and its free space"
        )
    return None
