"""A database by URL: transactions that read, transactions that write, and errors in the user's words."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection
from sqlalchemy.exc import StatementError

from bench.store.backend import Backend, Claim
from bench.store.errors import StoreFileError, StoreLockedError, StoreValueError
from bench.store.schema import UnreadableError
from bench.store.tables.json_text import NoJsonError
from bench.store.tables.unreadable import place_of_unreadable


class Database:
    """One engine, usable from several threads. Writers of this process take turns; readers never wait.

    Args:
        backend: what it is kept in.
        busy_timeout_s: how long a writer waits for another one [s].
    """

    def __init__(self, backend: Backend, busy_timeout_s: float) -> None:
        self.busy_timeout_s = busy_timeout_s
        self.backend = backend
        self._writer = threading.Lock()

    @property
    def where(self) -> str:
        """How messages name it."""
        return self.backend.where

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """A transaction that sees one state of the database throughout."""
        self.backend.begin_read()
        with self.explained(), self.backend.engine.connect() as connection, connection.begin():
            yield connection

    @contextmanager
    def writing(self, durable: bool = False) -> Iterator[Connection]:
        """A transaction that writes: committed when the block ends, undone when it raises.

        Args:
            durable: other machines act on it: a server keeps it, with all before it, whatever becomes of the server.
        """
        with self._writing_alone() as connection:
            self.backend.begin_write(connection)
            if durable:
                self.backend.make_durable(connection)
            yield connection

    @contextmanager
    def recording(self) -> Iterator[Connection]:
        """As `writing`, for statements whose results nobody looks at: a server gets them without waiting for each."""
        with self._writing_alone() as connection, self.backend.sending(connection):
            self.backend.begin_write(connection)
            yield connection

    @contextmanager
    def _writing_alone(self) -> Iterator[Connection]:
        """A transaction that writes; of this process it is the only one."""
        if not self._writer.acquire(timeout=self.busy_timeout_s):
            raise StoreLockedError(
                f"store '{self.where}': another thread has been writing for more than {self.busy_timeout_s:g} s; "
                "wait until the import has ended"
            )
        try:
            with self.explained(), self.backend.engine.connect() as connection:
                connection = connection.execution_options(**self.backend.write_options)
                with connection.begin():
                    yield connection
        finally:
            self._writer.release()

    def claim(self) -> Claim:
        """Say that this process runs experiments. Called inside a transaction that writes."""
        with self.explained():
            return self.backend.claim()

    def close(self) -> None:
        """Close all connections. Safe to call twice."""
        self.backend.engine.dispose()

    @contextmanager
    def explained(self) -> Iterator[None]:
        """Turn the errors of the driver into the store's."""
        try:
            yield
        except (
            OverflowError,
            UnicodeEncodeError,
            NoJsonError,
        ) as error:  # a number or text that the database cannot hold
            raise StoreValueError(f"store '{self.where}': {error}") from error
        except UnreadableError as error:
            raise StoreFileError(
                f"store '{self.where}'{place_of_unreadable(self.backend.engine)} cannot be read ({error}); restore a "
                "copy, or save what can be read: friction-bench store repair"
            ) from error
        except UnicodeDecodeError as error:  # what the database keeps, or says of itself, is no text any more
            damaged = f"store '{self.where}' is damaged ({error})"
            raise StoreFileError(
                f"{damaged}; restore a copy, or save what can be read: friction-bench store repair"
            ) from error
        except StatementError as error:
            if isinstance(error.orig, (TypeError, ValueError)):
                raise StoreValueError(f"store '{self.where}': {error.orig}") from error
            explained = self.backend.explain(error.orig)
            if explained is None:
                raise
            raise explained from error
