"""A new store from a damaged one: all that can be read of it, and in words what cannot."""

import json
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from datetime import datetime
from pathlib import Path
from typing import Any
from zlib import crc32

from sqlalchemy import JSON, Connection, Table, delete
from sqlalchemy.engine import make_url

from bench.store.address import database_of
from bench.store.errors import StoreFileError
from bench.store.migration import migrate
from bench.store.schema import CHAIN, METADATA, SAMPLE_BLOCK, SAMPLE_OVERVIEW, TRIAL, OwnerToken, PlainText, UtcDateTime
from bench.store.sqlite import file_of
from bench.store.tables import chain
from bench.store.tables.samples import SAMPLE_BYTES
from bench.store.upkeep.chain_check import broken_chain, ended
from bench.store.upkeep.gaps import fill_gaps
from bench.store.upkeep.salvage import UNREADABLE, columns_of, damaged, rows_of

# a kind of column, what reads it or raises, and what stands in the place of what cannot be read
READERS: tuple[tuple[type, Callable[[Any], object], str], ...] = (
    (JSON, lambda value: json.loads(value), "{}"),
    (UtcDateTime, lambda value: datetime.fromisoformat(value), "1970-01-01 00:00:00.000000"),
    (OwnerToken, lambda value: _owner(value), ""),
    (PlainText, lambda value: _text(value), ""),
)
BLOCKS = (SAMPLE_BLOCK.name, SAMPLE_OVERVIEW.name)


def repair(source: str, target: Path) -> list[str]:
    """Save what can be read of a damaged SQLite store; the damaged file stays as it is.

    Args:
        source: URL of the store.
        target: a file to make.

    Returns:
        What is lost or altered, in words; empty where nothing is.

    Raises:
        StoreFileError: the source is no SQLite file that is there, or the target is there already.
    """
    path = file_of(make_url(source))
    if not path.is_file():
        raise StoreFileError(f"store '{path}' is not there; name the damaged file with --store")
    if target.exists():
        raise StoreFileError(f"repair: '{target}' is there already; name another file, or remove it")
    made = database_of(f"sqlite:///{target.absolute()}", 10.0)
    try:
        migrate(made)
        lost = list(_copy(path, target))
        with made.writing() as connection:
            lost += fill_gaps(connection)
            lost += _chained_anew(connection)
        return lost
    finally:
        made.close()


def _copy(source: Path, target: Path) -> Iterator[str]:
    with damaged(source) as read, closing(sqlite3.connect(target)) as write:
        write.execute("PRAGMA foreign_keys = OFF")  # a child may be there without its parent
        for table in METADATA.sorted_tables:
            yield from _copy_table(read, write, table)
        yield from _without_orphans(write)
        write.commit()


def _copy_table(read: sqlite3.Connection, write: sqlite3.Connection, table: Table) -> Iterator[str]:
    there = _columns(table, columns_of(read, table.name))
    names = list(there)
    if not names:
        yield f"table {table.name}: nothing of it can be read"
        return
    places = ", ".join("?" * len(names))
    order = f"INSERT INTO {table.name} ({', '.join(names)}) VALUES ({places})"  # noqa: S608  names of our schema
    for row in rows_of(read, table.name, list(there.values())):
        values = dict(zip(names, row, strict=True))
        if table.name in BLOCKS and not _is_sound(values):
            continue  # what it held is told with its trial
        yield from _readable(table, values)
        try:
            write.execute(order, list(values.values()))
        except UNREADABLE as error:
            yield f"{table.name} {row[0]}: not what can be kept ({error})"


def _columns(table: Table, there: list[str]) -> dict[str, str]:
    """Our name of a column -> that in the file. One name that nobody knows is the one that is missing, damaged."""
    ours = [column.name for column in table.columns]
    found = {name: name for name in ours if name in there}
    missing, unknown = [name for name in ours if name not in there], [name for name in there if name not in ours]
    if len(missing) == len(unknown) == 1:
        found[missing[0]] = unknown[0]
    return found


def _is_sound(block: dict[str, object]) -> bool:
    data, told = block["data"], block.get("crc32")
    return isinstance(data, bytes) and len(data) > 0 and (told is None or crc32(data) == told)


def _readable(table: Table, values: dict[str, object]) -> Iterator[str]:
    """Put nothing, or the first day of all, in the place of what can no longer be read."""
    for column in table.columns:
        value = values.get(column.name)
        for kind, read, instead in READERS:
            if value is None or not isinstance(column.type, kind):
                continue
            try:
                read(value)
            except (ValueError, TypeError, RecursionError):
                values[column.name] = instead
                yield f"{table.name} {values.get('id', '')}: its {column.name} is lost, and '{instead}' since a repair"
                break


def _owner(value: object) -> None:
    if not OwnerToken.FORM.fullmatch(str(value)):
        raise ValueError


def _text(value: object) -> None:
    if not isinstance(value, str) or "\0" in value:
        raise ValueError


def _without_orphans(write: sqlite3.Connection) -> Iterator[str]:
    """Remove what belongs to a record that is lost, and trials whose channels or rows nobody knows."""
    write.execute(f"DELETE FROM {TRIAL.name} WHERE channels NOT LIKE '[%\"time_s\"%]'")  # noqa: S608
    found = write.execute(
        f"SELECT b.rowid FROM {SAMPLE_BLOCK.name} b JOIN {TRIAL.name} t ON t.id = b.trial_id "  # noqa: S608
        f"WHERE length(b.data) != b.rows * json_array_length(t.channels) * {SAMPLE_BYTES}"
    ).fetchall()
    write.executemany(f"DELETE FROM {SAMPLE_BLOCK.name} WHERE rowid = ?", found)  # noqa: S608
    while broken := write.execute("PRAGMA foreign_key_check").fetchall():
        for name, row, *_ in broken:
            write.execute(f'DELETE FROM "{name}" WHERE rowid = ?', (row,))  # noqa: S608
        for name, parent in sorted({(name, parent) for name, _, parent, _ in broken}):
            count = sum((one[0], one[2]) == (name, parent) for one in broken)
            yield f"{name}: {count} rows without their {parent}, which is lost"


def _chained_anew(connection: Connection) -> list[str]:
    """What the chain says of the loss; then a new one over what is there, as the old one is not borne out any more."""
    found = broken_chain(connection)
    if found:
        connection.execute(delete(CHAIN))
        for subject in chain.SUBJECTS:
            chain.seal(connection, subject, connection.execute(ended(subject)).scalars().all())
        found.append("the hash chain is begun anew over what was saved; keep the damaged file for the old one")
    return found
