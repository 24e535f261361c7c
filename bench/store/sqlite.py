"""SQLite: all that is special about it.

WAL lets readers go on while one writer writes, and with synchronous = NORMAL what was committed
survives the death of the process (a power cut may cost the last commits, never the database).
Transactions that write take the write lock when they begin, so that the busy time-out applies:
SQLite does not wait when a reading transaction turns into a writing one.
"""

import os
import shutil
import sqlite3
import time
from collections.abc import Mapping
from contextlib import AbstractContextManager, closing, nullcontext
from pathlib import Path
from urllib.parse import quote

from sqlalchemy import Connection, Engine, Pool, create_engine, event
from sqlalchemy.engine import URL
from sqlalchemy.pool import ConnectionPoolEntry

from bench.store.errors import StoreError, StoreFileError, StoreFullError, StoreLockedError, StoreReadOnlyError
from bench.store.tables.json_text import from_json, to_json
from bench.store.upkeep import owner

_EFFECTIVE = os.access in os.supports_effective_ids
WAL_LIMIT_BYTES = 64 * 2**20  # the log is cut back to this after a large import
PAGE_BYTES = 16_384  # of a new file: blocks are read 1.6 times as fast as with SQLite's 4096, measured
RETRY_S = 0.01
OWNERS_MODE = 0o600  # of a new file: who may read the bench's records is its owner's to say
WRITES = "writes"  # execution option of connections that are going to write


class SqliteFile:
    """A database file and its log.

    Args:
        path: of the database, absolute; it need not be there yet.

    Attributes:
        is_read_only: the file or its folder may not be written: it is read as it is, and nothing is made beside it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.is_read_only = path.exists() and not (_may_write(path) and _may_write(path.parent))
        self._inode: int | None = None

    @property
    def log(self) -> Path:
        """Where SQLite keeps what was committed and is not yet in the file."""
        return self.path.with_name(f"{self.path.name}-wal")

    def connect(self, busy_timeout_s: float) -> sqlite3.Connection:
        """A connection; the file is made by the first one alone.

        Args:
            busy_timeout_s: how long a statement waits for a lock of another connection [s].

        Raises:
            StoreFileError: it was taken away since.
            sqlite3.Error: as SQLite says it.
        """
        self.require()
        address = f"file:{quote(str(self.path))}?mode={self._mode()}"
        # the lock must be waited for from the first statement on
        made = sqlite3.connect(address, uri=True, timeout=busy_timeout_s, check_same_thread=False)
        self._inode = self._inode or self._found()
        return made

    def require(self) -> None:
        """Refuse to go on with a file that is not there any more, or with another one in its place.

        SQLite would go on: it would write rows that nobody finds again, and read of a file that is empty.

        Raises:
            StoreFileError: with the next step.
        """
        if self._inode is not None and self._found() != self._inode:
            raise StoreFileError(
                f"store '{self.path}' was deleted, moved or replaced while it was in use; nothing more can be kept or "
                "read. Put the file back if you can, and start this program again"
            )

    def _mode(self) -> str:
        if not self.is_read_only:
            return "rwc" if self._inode is None else "rw"
        # without a log nothing can change it, and SQLite needs no file beside it to tell other programs so
        has_log = self.log.exists() and self.log.stat().st_size > 0
        return "ro" if has_log else "ro&immutable=1"

    def _found(self) -> int | None:
        try:
            return self.path.stat().st_ino
        except (FileNotFoundError, NotADirectoryError):
            return None


def _may_write(path: Path) -> bool:
    return os.access(path, os.W_OK, effective_ids=_EFFECTIVE)


class Sqlite:
    """See `Backend`.

    Args:
        url: "sqlite:///bench.sqlite" (relative) or "sqlite:////home/lab/bench.sqlite" (absolute).
        busy_timeout_s: how long a writer waits for another one [s].

    Raises:
        StoreFileError: the URL names no file, or the folder does not exist.
    """

    def __init__(self, url: URL, busy_timeout_s: float) -> None:
        self.file = SqliteFile(file_of(url))
        self.path = self.file.path
        self.where = str(self.path)
        self.write_options: Mapping[str, str | bool] = {WRITES: True}
        self._busy_timeout_s = busy_timeout_s
        self.engine = _engine(self.file, busy_timeout_s)

    @property
    def is_read_only(self) -> bool:
        """The file or its folder may not be written."""
        return self.file.is_read_only

    def begin_read(self) -> None:
        """Refuse to read of a file that is not there any more: connections that are open would go on as if it were."""
        self.file.require()

    def begin_write(self, connection: Connection) -> None:  # noqa: ARG002  BEGIN IMMEDIATE has waited already
        """Refuse to write into a file that is not there any more, or may not be written: every row would be lost."""
        self.file.require()
        if self.is_read_only:
            raise _read_only(self.path)

    def make_durable(self, connection: Connection) -> None:
        """As every transaction: a power cut may cost the last ones. A laboratory of several machines has a server."""

    def sending(self, connection: Connection) -> AbstractContextManager[object]:  # noqa: ARG002
        """Nobody is far: each statement is done when it returns."""
        return nullcontext()

    def explain(self, error: BaseException | None) -> StoreError | None:
        """By SQLite's name of the error."""
        return explain(error, self.path, self._busy_timeout_s)

    def size_bytes(self) -> int:
        """Of the file and its log."""
        files = (self.path, self.file.log)
        return sum(file.stat().st_size for file in files if file.exists())

    def free_bytes(self) -> int:
        """On the disk of the file."""
        return shutil.disk_usage(self.path.parent).free

    def check(self) -> list[str]:
        """By SQLite's own check of the whole file, and of what belongs to what."""
        try:
            with closing(self.file.connect(self._busy_timeout_s)) as connection:
                found = [str(row[0]) for row in connection.execute("PRAGMA integrity_check") if row[0] != "ok"]
                broken = connection.execute("PRAGMA foreign_key_check").fetchall()
        except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
            return [f"the file is damaged: {error}"]
        return found + [f"{table}, row {row}: its {parent} is gone" for table, row, parent, _ in broken]

    def vacuum(self) -> None:
        """Rewrite the file."""
        with self.engine.connect() as connection:
            raw = connection.connection.driver_connection
            if raw is not None:  # outside a transaction, which SQLAlchemy would begin
                for statement in ("VACUUM", "ANALYZE", "PRAGMA wal_checkpoint(TRUNCATE)"):
                    raw.execute(statement).fetchall()

    def claim(self) -> owner.Owner:
        """A locked file beside the database."""
        return owner.Owner(self.path)

    def lives(self, token: str | None) -> bool:
        """Whether the file of a claim is still locked."""
        return owner.lives(self.path, token)

    def last_words(self, token: str | None) -> dict[int, tuple[str, str]]:
        """From the file of a claim."""
        return owner.last_words(self.path, token)

    def forget(self, token: str | None) -> None:
        """Remove the file of a claim."""
        owner.forget(self.path, token)


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


def _engine(file: SqliteFile, busy_timeout_s: float) -> Engine:
    fresh = not file.path.exists()
    engine = create_engine(
        URL.create("sqlite", database=str(file.path)),
        creator=lambda: file.connect(busy_timeout_s),
        max_overflow=-1,
        json_serializer=to_json,
        json_deserializer=from_json,
    )

    def prepare(connection: sqlite3.Connection, record: ConnectionPoolEntry | Pool) -> None:  # noqa: ARG001
        connection.isolation_level = None  # transactions are begun by _begin, not by Python's module
        connection.execute("PRAGMA foreign_keys = ON")
        if file.is_read_only:
            return
        connection.execute(f"PRAGMA page_size = {PAGE_BYTES}")
        _use_wal(connection, busy_timeout_s)
        if fresh:
            file.path.chmod(OWNERS_MODE)
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute(f"PRAGMA journal_size_limit = {WAL_LIMIT_BYTES}")

    event.listen(engine.pool, "connect", prepare)
    event.listen(engine, "begin", _begin)
    return engine


def _use_wal(connection: sqlite3.Connection, busy_timeout_s: float) -> None:
    """Switch to WAL. Where several processes do so at once SQLite fails without having waited, so this waits."""
    deadline_s = time.monotonic() + busy_timeout_s
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if not _name(error).startswith(("SQLITE_BUSY", "SQLITE_LOCKED")) or time.monotonic() > deadline_s:
                raise
        time.sleep(RETRY_S)


def _begin(connection: Connection) -> None:
    writes = connection.get_execution_options().get(WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _name(error: sqlite3.Error) -> str:
    return getattr(error, "sqlite_errorname", None) or ""


def explain(error: BaseException | None, path: Path, busy_timeout_s: float) -> StoreError | None:
    """The store's error for an error of SQLite, with the next step; None where it is none of these."""
    if not isinstance(error, sqlite3.Error):
        return None
    name = _name(error)
    where = f"store '{path}'"
    if name.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")):
        return StoreLockedError(
            f"{where} is locked by another process for more than {busy_timeout_s:g} s; "
            "end what holds it (an import, another friction-bench, a backup, an SQLite browser), then try again"
        )
    if name.startswith("SQLITE_FULL"):
        return StoreFullError(f"{where}: the disk is full; free some space, then start again. Earlier blocks are kept")
    if name.startswith("SQLITE_READONLY"):
        return _read_only(path)
    if name.startswith("SQLITE_CANTOPEN"):
        return StoreReadOnlyError(
            f"{where} cannot be opened or created; make its folder readable and writable, or copy the file, with its "
            "-wal where it has one, to a folder that is"
        )
    if name.startswith("SQLITE_NOTADB"):
        return StoreFileError(f"{where} is not an SQLite database; name another file")
    if name.startswith("SQLITE_CORRUPT"):
        return StoreFileError(
            f"{where} is damaged ({error}); restore a copy, or save what can be read: friction-bench store repair"
        )
    if name.startswith("SQLITE_IOERR"):
        return StoreFileError(
            f"{where}: the disk reports an error ({name}: {error}); check the disk and its free space"
        )
    return None


def _read_only(path: Path) -> StoreReadOnlyError:
    where = f"store '{path}'"
    return StoreReadOnlyError(f"{where} is read-only; make the file and its folder writable, or name another file")
