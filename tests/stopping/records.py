"""The store of a killed bench, as another program sees it: a file, or a database on a PostgreSQL server."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, Protocol

from bench.store.postgresql import WRITER_KEY

PATIENCE_S = 120.0


class Records(Protocol):
    """What a deed does to a store, and what is looked for in it.

    Attributes:
        url: of the store.
        is_file: whether the bench itself writes its files, so that its own disk can be full.
    """

    url: str
    is_file: bool

    def newest(self, query: str) -> Any:
        """The first row of a query, as it is committed now; None where there is none."""

    def locked(self) -> Any:
        """A context in which another program writes, and lets nobody else write."""

    def problems(self) -> list[str]:
        """What the database itself finds wrong."""


class FileRecords:
    """A SQLite file; see `Records`."""

    is_file = True

    def __init__(self, path: Path) -> None:
        self.url, self._path = f"sqlite:///{path}", path

    def newest(self, query: str) -> Any:
        with closing(sqlite3.connect(f"file:{self._path}?mode=ro", uri=True)) as connection:
            return connection.execute(query).fetchone()

    @contextmanager
    def locked(self) -> Iterator[None]:
        with closing(sqlite3.connect(self._path, isolation_level=None, timeout=PATIENCE_S)) as other:
            other.execute("BEGIN IMMEDIATE")
            yield
            other.execute("ROLLBACK")

    def problems(self) -> list[str]:
        with closing(sqlite3.connect(self._path)) as connection:
            sound = connection.execute("PRAGMA integrity_check").fetchone()[0]
        return [] if sound == "ok" else [f"integrity_check says {sound}"]


class ServerRecords:
    """A database on a server; see `Records`."""

    is_file = False

    def __init__(self, url: str) -> None:
        import psycopg

        self.url = url
        self._connection = psycopg.connect(url, autocommit=True)

    def newest(self, query: str) -> Any:
        return self._connection.execute(query).fetchone()

    @contextmanager
    def locked(self) -> Iterator[None]:
        with self._connection.transaction(force_rollback=True):
            self._connection.execute("SELECT pg_advisory_xact_lock(%s)", (WRITER_KEY,))
            yield

    def problems(self) -> list[str]:
        """Nothing: a server checks what it reads, and refuses it."""
        return []

    def close(self) -> None:
        self._connection.close()
