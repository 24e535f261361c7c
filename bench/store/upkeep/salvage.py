"""Reading what can be read of a damaged SQLite file, row by row: a page that is broken costs its own rows alone."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote

Row = tuple[Any, ...]
UNREADABLE = (sqlite3.DatabaseError, UnicodeDecodeError, OverflowError)


@contextmanager
def damaged(path: Path) -> Iterator[sqlite3.Connection]:
    """A connection that writes nothing, and reads text that is none with a sign in the place of what is broken."""
    with closing(sqlite3.connect(f"file:{quote(str(path))}?mode=ro", uri=True)) as connection:
        connection.text_factory = lambda found: found.decode("utf-8", "replace")
        connection.execute("PRAGMA writable_schema = ON")  # a table whose description is broken hides no other one
        yield connection


def columns_of(connection: sqlite3.Connection, table: str) -> list[str]:
    """Names of the columns of a table; none where it cannot be told."""
    try:
        return [row[1] for row in connection.execute(f'PRAGMA table_info("{table}")')]
    except UNREADABLE:
        return []


def rows_of(connection: sqlite3.Connection, table: str, columns: list[str]) -> Iterator[Row]:
    """Every row that can be read, in the order of the file's own numbers."""
    names = ", ".join(f'"{name}"' for name in columns)
    query = f'SELECT rowid, {names} FROM "{table}" WHERE rowid > ? ORDER BY rowid'  # noqa: S608  names of our schema
    last, newest = 0, _newest(connection, table)
    while True:
        try:
            for number, *values in connection.execute(query, (last,)):
                last = number
                yield tuple(values)
            return
        except UNREADABLE:
            following = _following(connection, f"{query} LIMIT 1", last, newest)
            if following is None:
                return
            last = following


def _newest(connection: sqlite3.Connection, table: str) -> int:
    try:
        return int(connection.execute(f'SELECT max(rowid) FROM "{table}"').fetchone()[0] or 0)  # noqa: S608
    except UNREADABLE:
        return 2**20  # the way to it is broken: as far as a bench comes


def _following(connection: sqlite3.Connection, query: str, last: int, newest: int) -> int | None:
    """The least number, behind the last one that was read, after which a row can be read again; None: there is none."""
    step = 1
    while last + step <= newest and not _is_readable(connection, query, last + step):
        step *= 2
    if last + step > newest:
        return None
    low, high = last + step // 2, last + step  # not readable, readable
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if _is_readable(connection, query, middle) else (middle, high)
    return high


def _is_readable(connection: sqlite3.Connection, query: str, after: int) -> bool:
    try:
        return connection.execute(query, (after,)).fetchone() is not None
    except UNREADABLE:
        return False
