"""A new store from a damaged one: all that can be read of it, and in words what cannot."""

import json
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any
from urllib.parse import quote
from zlib import crc32

import numpy as np
from sqlalchemy import JSON, Connection, Table, delete, insert, select, update
from sqlalchemy.engine import make_url

from bench.store.address import database_of
from bench.store.errors import StoreFileError
from bench.store.migration import migrate
from bench.store.schema import CHAIN, METADATA, SAMPLE_BLOCK, SAMPLE_OVERVIEW, TRIAL, OwnerToken, PlainText, UtcDateTime
from bench.store.sqlite import file_of
from bench.store.tables import chain
from bench.store.tables.samples import SAMPLE_BYTES, decode, encode
from bench.store.upkeep.chain_check import broken_chain, ended
from compensator.lab.recordings.recording import FloatArray

Row = tuple[Any, ...]
UNREADABLE = (sqlite3.DatabaseError, UnicodeDecodeError, OverflowError)
# a kind of column, what reads it or raises, and what stands in the place of what cannot be read
READERS: tuple[tuple[type, Callable[[Any], object], str], ...] = (
    (JSON, lambda value: json.loads(value), "{}"),
    (UtcDateTime, lambda value: datetime.fromisoformat(value), "1970-01-01 00:00:00.000000"),
    (OwnerToken, lambda value: _owner(value), ""),
    (PlainText, lambda value: _text(value), ""),
)
BLOCKS = (SAMPLE_BLOCK.name, SAMPLE_OVERVIEW.name)


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


def fill_gaps(connection: Connection) -> Iterator[str]:
    """Fill the lost rows of each trial with NaN, cut off a lost end, and mark the trial as interrupted.

    Times are spread evenly between their neighbours, as they have to rise. An overview is left out: without one, plots
    read all rows.

    Yields:
        What is lost, in words.
    """
    for trial_id, rows, channels in connection.execute(select(TRIAL.c.id, TRIAL.c.rows, TRIAL.c.channels)).all():
        lost = list(_fill(connection, trial_id, rows, channels))
        if lost:
            words = f"rows {', '.join(lost)} of {rows} are lost, and empty or cut off since a repair of the store"
            changed = update(TRIAL).where(TRIAL.c.id == trial_id).values(outcome="interrupted", reason=words)
            connection.execute(changed)
            connection.execute(delete(SAMPLE_OVERVIEW).where(SAMPLE_OVERVIEW.c.trial_id == trial_id))
            yield f"trial {trial_id}: {words}"


def _fill(connection: Connection, trial_id: int, rows: int, channels: list[str]) -> Iterator[str]:
    table = SAMPLE_BLOCK.c
    query = select(table.first_row, table.rows).where(table.trial_id == trial_id).order_by(table.first_row)
    covered = 0
    for first, count in connection.execute(query).all():
        if first > covered:
            yield f"{covered} .. {first - 1}"
            between = _empty(connection, trial_id, (covered, first), channels)
            values = {"trial_id": trial_id, "first_row": covered, "rows": first - covered, "data": encode(between)}
            connection.execute(insert(SAMPLE_BLOCK).values(**values))
        covered = max(covered, first + count)
    if covered != rows:
        yield f"{covered} .. {rows - 1}"
        connection.execute(update(TRIAL).where(TRIAL.c.id == trial_id).values(rows=covered))


def _empty(connection: Connection, trial_id: int, gap: tuple[int, int], channels: list[str]) -> FloatArray:
    """Columns for the rows of a gap, shape (channels, rows): times between those of its neighbours, all else NaN."""
    count, time = gap[1] - gap[0], channels.index("time_s")
    found = np.full((len(channels), count), np.nan)
    after = _times(connection, trial_id, gap[1], time)
    before = _times(connection, trial_id, gap[0], time, ends_there=True)
    if len(before):
        found[time] = np.linspace(before[-1], after[0], count + 2)[1:-1]
    else:  # the beginning: by the period of what follows
        period_s = after[1] - after[0] if len(after) > 1 else 0.0
        found[time] = after[0] - period_s * np.arange(count, 0, -1)
    return found


def _times(connection: Connection, trial_id: int, row: int, time: int, ends_there: bool = False) -> FloatArray:
    """Times of the block that begins at a row, or ends before it; none where there is no such block."""
    table = SAMPLE_BLOCK.c
    place = table.first_row + table.rows if ends_there else table.first_row
    query = select(table.data, table.rows).where(table.trial_id == trial_id, place == row)
    found = connection.execute(query).first()
    if found is None:
        return np.empty(0)
    times: FloatArray = decode(found.data, len(found.data) // (8 * found.rows))[time]
    return times


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
