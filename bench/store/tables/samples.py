"""Samples of a trial: blocks in, arrays out. Each function works inside the caller's transaction."""

from collections.abc import Iterator, Mapping, Sequence
from zlib import crc32

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import Connection, bindparam, case, insert, select, update

from bench.store.errors import NotFoundError, StoreValueError
from bench.store.records import Trial
from bench.store.schema import SAMPLE_BLOCK, SAMPLE_OVERVIEW, TRIAL
from bench.store.tables.plotted.overview import asked_by, asked_by_all, overview_of
from compensator.lab.recordings.recording import FloatArray

STORED = np.dtype("<f8")
SAMPLE_BYTES = STORED.itemsize


def columns_of(rows: FloatArray) -> FloatArray:
    """Rows, shape (rows, channels), as columns in memory, shape (channels, rows)."""
    return np.ascontiguousarray(np.asarray(rows, dtype=STORED).T)


def encode(columns: FloatArray) -> bytes:
    """Bytes of a block.

    Args:
        columns: shape (channels, rows).
    """
    return np.asarray(columns, dtype=STORED).tobytes(order="C")


def decode(data: bytes, channels: int) -> NDArray[np.float64]:
    """Columns of a block, shape (channels, rows), read-only."""
    return np.frombuffer(data, dtype=STORED).reshape(channels, -1)


BLOCK_ROWS = 8192  # larger appends are cut into blocks of this size; twice as fast to read as 65 536, measured
LARGEST_BLOCK_ROWS = 65_536  # earlier versions cut so
FETCHED_BLOCKS = 16  # in memory at a time, where the database sends them one by one

_INSERT = insert(SAMPLE_BLOCK)
_INSERT_OVERVIEW = insert(SAMPLE_OVERVIEW)
# NULL, which the table refuses, where the trial has not the rows that it should have: no gap is written
_COUNT = (
    update(TRIAL)
    .where(TRIAL.c.id == bindparam("trial"))
    .values(rows=case((TRIAL.c.rows == bindparam("before"), bindparam("total"))))
)


def add(
    connection: Connection, trial_id: int, first_row: int, rows: FloatArray, pending: FloatArray | None = None
) -> FloatArray:
    """Insert rows behind those that the trial has already, and their share of the overview.

    Args:
        connection: inside a transaction that writes.
        trial_id: the trial.
        first_row: how many rows the trial has already.
        rows: shape (rows, channels).
        pending: the newest rows of the trial that no overview covers yet, as columns; None for none.

    Returns:
        The rows that are pending now, shape (channels, less than a group).
    """
    for start in range(0, len(rows), BLOCK_ROWS):
        columns = columns_of(rows[start : start + BLOCK_ROWS])
        # one by one: a server works on a block while the next one is made
        connection.execute(_INSERT, _block(trial_id, first_row + start, columns.shape[1], encode(columns)))
        piece, pending = _overview(trial_id, first_row + start, columns, pending)
        if piece is not None:
            connection.execute(_INSERT_OVERVIEW, piece)
    if len(rows):
        connection.execute(_COUNT, {"trial": trial_id, "before": first_row, "total": first_row + len(rows)})
    return np.empty((rows.shape[1], 0)) if pending is None else pending


def _overview(
    trial_id: int, first_row: int, columns: FloatArray, pending: FloatArray | None
) -> tuple[dict[str, object] | None, FloatArray]:
    """The row of the overview's table, if whole groups have come together, and what is pending then."""
    if pending is not None and pending.shape[1]:
        first_row -= pending.shape[1]
        columns = np.hstack([pending, columns])
    found = overview_of(columns)
    rest = columns[:, found.covered :].copy()
    if not found.covered:
        return None, rest
    data = encode(np.vstack([found.rows, found.asked_by, found.columns]))
    return _block(trial_id, first_row, found.covered, data), rest


def _block(trial_id: int, first_row: int, rows: int, data: bytes) -> dict[str, object]:
    return {"trial_id": trial_id, "first_row": first_row, "rows": rows, "data": data, "crc32": crc32(data)}


def damaged_blocks(connection: Connection) -> Iterator[tuple[str, int, int, int]]:
    """Blocks whose data are not what was written: what they are of, their trial, first row and count of rows."""
    for what, table in (("samples", SAMPLE_BLOCK), ("overview", SAMPLE_OVERVIEW)):
        own = table.c
        query = select(own.trial_id, own.first_row, own.rows, own.data, own.crc32).where(own.crc32.is_not(None))
        found = connection.execute(
            query.order_by(own.trial_id, own.first_row), execution_options={"yield_per": FETCHED_BLOCKS}
        )
        yield from ((what, trial, first, rows) for trial, first, rows, data, told in found if crc32(data) != told)


def read(connection: Connection, trial: Trial, channels: Sequence[str]) -> dict[str, FloatArray]:
    """Channel name -> samples, each of shape (trial.rows,).

    Raises:
        NotFoundError: a channel that the trial does not have.
    """
    columns = {channel: column_of(trial, channel) for channel in channels}
    samples = {channel: np.empty(trial.rows) for channel in columns}
    for first_row, block in _blocks(connection, trial, 0, trial.rows):
        for channel, column in columns.items():
            samples[channel][first_row : first_row + block.shape[1]] = block[column]
    return samples


def read_part(connection: Connection, trial: Trial, first_row: int, rows: int) -> FloatArray:
    """Some rows of a trial, all channels, shape (channels, up to `rows`); none behind its end.

    Raises:
        NotFoundError: they were removed meanwhile.
    """
    last = min(first_row + rows, trial.rows)
    part, found = np.empty((len(trial.channels), max(0, last - first_row))), 0
    for start, block in _blocks(connection, trial, first_row, last):
        low, high = max(start, first_row), min(start + block.shape[1], last)
        part[:, low - first_row : high - first_row] = block[:, low - start : high - start]
        found += high - low
    if found != part.shape[1]:
        raise NotFoundError(f"trial {trial.id} was removed while it was read; list the trials to see which are there")
    return part


def read_overview(
    connection: Connection, trial: Trial, names: Sequence[str]
) -> tuple[dict[str, FloatArray], dict[str, NDArray[np.bool_]]]:
    """Of some channels the rows of the overview, and all rows that it does not cover.

    What was recorded by a version without overviews has none: then these are all its rows.

    Returns:
        Channel name -> samples of those rows, shape (k,); channel name -> whether each row matters to it, shape (k,).

    Raises:
        NotFoundError: a channel that the trial does not have.
    """
    wanted = {name: column_of(trial, name) for name in names}
    channels = len(trial.channels)
    covered, parts, asked = 0, [], []
    table = SAMPLE_OVERVIEW.c
    query = select(table.first_row, table.rows, table.data).where(table.trial_id == trial.id)
    for first_row, rows, data in connection.execute(query.order_by(table.first_row)):
        if first_row != covered:
            break
        columns = decode(data, 2 + channels)
        asked.append(columns[1])
        parts.append(columns[2:])
        covered += rows
    rest = read_part(connection, trial, covered, trial.rows - covered)
    asked.append(np.full(rest.shape[1], asked_by_all(channels)))
    parts.append(rest)
    numbers = np.concatenate(asked).astype(np.int64)
    found = {name: np.concatenate([part[column] for part in parts]) for name, column in wanted.items()}
    return found, {name: asked_by(column, numbers) for name, column in wanted.items()}


def check_shape(rows: FloatArray, channels: int) -> None:
    """Refuse rows that do not fit the channels.

    Raises:
        StoreValueError: not of shape (n, channels).
    """
    if rows.ndim != 2 or rows.shape[1] != channels:
        raise StoreValueError(f"rows have the shape {rows.shape}; wanted (any number, {channels}): one per channel")


def rows_of(channels: Mapping[str, FloatArray], start: int, count: int) -> FloatArray:
    """Some rows of channels that have the same length, shape (up to count, channels)."""
    return np.column_stack([values[start : start + count] for values in channels.values()])


def _blocks(connection: Connection, trial: Trial, first_row: int, last_row: int) -> Iterator[tuple[int, FloatArray]]:
    """The blocks that hold any of the rows first_row .. last_row - 1, each with its own first row."""
    table = SAMPLE_BLOCK.c
    query = select(table.first_row, table.data).where(
        table.trial_id == trial.id,
        table.first_row > first_row - LARGEST_BLOCK_ROWS,  # for the index; the next says which of these it is
        table.first_row + table.rows > first_row,
        table.first_row < last_row,
    )
    options = {"yield_per": FETCHED_BLOCKS}
    for start, data in connection.execute(query.order_by(table.first_row), execution_options=options):
        yield start, decode(data, len(trial.channels))


def column_of(trial: Trial, channel: str) -> int:
    """Where a channel stands among the trial's; NotFoundError where it has none of that name."""
    if channel not in trial.channels:
        raise NotFoundError(f"trial {trial.id} has no channel '{channel}'; it has {', '.join(trial.channels)}")
    return trial.channels.index(channel)
