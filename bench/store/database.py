"""A database by URL: transactions that read, transactions that write, and errors in the user's words."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection
from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError, StatementError

from bench.store import sqlite
from bench.store.errors import StoreFileError, StoreLockedError, StoreValueError


class Database:
    """One engine, usable from several threads. Writers of this process take turns; readers never wait.

    Args:
        url: "sqlite:///bench.sqlite" (relative) or "sqlite:////home/lab/bench.sqlite" (absolute).
        busy_timeout_s: how long a writer waits for another one [s].

    Raises:
        StoreFileError: the URL cannot be read, names no file, or the folder does not exist.
    """

    def __init__(self, url: str, busy_timeout_s: float) -> None:
        try:
            parsed = make_url(url)
        except ArgumentError as error:
            raise StoreFileError(f"store '{url}' is no database URL; write sqlite:///bench.sqlite") from error
        if parsed.get_backend_name() != "sqlite":
            found = parsed.get_backend_name()
            raise StoreFileError(f"store: database '{found}' is not supported; write sqlite:///bench.sqlite")
        self.path = sqlite.file_of(parsed)
        self.busy_timeout_s = busy_timeout_s
        self._engine = sqlite.create(self.path, busy_timeout_s)
        self._writer = threading.Lock()
        self._inode: int | None = None

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction that sees one state of the database throughout."""
        with self._explained(), self._engine.connect() as connection, connection.begin():
            yield connection

    @contextmanager
    def writing(self) -> Iterator[Connection]:
        """A transaction that writes: committed when the block ends, undone when it raises."""
        if not self._writer.acquire(timeout=self.busy_timeout_s):
            raise StoreLockedError(
                f"store '{self.path}': another thread has been writing for more than {self.busy_timeout_s:g} s; "
                "wait until the import has ended"
            )
        try:
            with self._explained(), self._engine.connect() as connection:
                connection = connection.execution_options(**{sqlite.WRITES: True})
                with connection.begin():
                    self._check_file()
                    yield connection
        finally:
            self._writer.release()

    def close(self) -> None:
        """Close all connections. Safe to call twice."""
        self._engine.dispose()

    def _check_file(self) -> None:
        """Refuse to write into a file that is not there any more: SQLite would, and every row would be lost."""
        try:
            found = self.path.stat().st_ino
        except FileNotFoundError:
            found = None
        self._inode = self._inode or found
        if found is None or found != self._inode:
            raise StoreFileError(
                f"store '{self.path}' was deleted, moved or replaced while it was in use; nothing more can be kept. "
                "Put the file back if you can, and start this program again"
            )

    @contextmanager
    def _explained(self) -> Iterator[None]:
        try:
            yield
        except (OverflowError, UnicodeEncodeError) as error:  # a number or text that SQLite cannot hold
            raise StoreValueError(f"store '{self.path}': {error}") from error
        except StatementError as error:
            if isinstance(error.orig, (TypeError, UnicodeEncodeError)):
                raise StoreValueError(f"store '{self.path}': {error.orig}") from error
            explained = sqlite.explain(error.orig, self.path, self.busy_timeout_s)
            if explained is None:
                raise
            raise explained from error
