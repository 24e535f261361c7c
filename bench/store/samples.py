"""Samples of a trial: blocks in, arrays out. Each function works inside the caller's transaction."""

from collections.abc import Mapping, Sequence

import numpy as np
from sqlalchemy import Connection, bindparam, insert, select, update

from bench.store.blocks import decode, encode
from bench.store.errors import NotFoundError, StoreValueError
from bench.store.records import Trial
from bench.store.schema import SAMPLE_BLOCK, TRIAL
from compensator.lab.recording import FloatArray

BLOCK_ROWS = 65_536  # larger appends are cut into blocks of this size

_INSERT = insert(SAMPLE_BLOCK)
_COUNT = update(TRIAL).where(TRIAL.c.id == bindparam("trial")).values(rows=bindparam("total"))


def add(connection: Connection, trial_id: int, first_row: int, rows: FloatArray) -> None:
    """Insert rows of shape (rows, channels) behind the `first_row` rows that the trial has already."""
    for start in range(0, len(rows), BLOCK_ROWS):
        part = rows[start : start + BLOCK_ROWS]
        block = {"trial_id": trial_id, "first_row": first_row + start, "rows": len(part), "data": encode(part)}
        connection.execute(_INSERT, block)
    connection.execute(_COUNT, {"trial": trial_id, "total": first_row + len(rows)})


def read(connection: Connection, trial: Trial, channels: Sequence[str]) -> dict[str, FloatArray]:
    """Channel name -> samples, each of shape (trial.rows,).

    Raises:
        NotFoundError: a channel that the trial does not have.
    """
    columns = {channel: _column(trial, channel) for channel in channels}
    samples = {channel: np.empty(trial.rows) for channel in columns}
    table = SAMPLE_BLOCK.c
    query = select(table.first_row, table.rows, table.data).where(table.trial_id == trial.id)
    for first_row, rows, data in connection.execute(query.order_by(table.first_row)):
        block = decode(data, len(trial.channels))
        for channel, column in columns.items():
            samples[channel][first_row : first_row + rows] = block[column]
    return samples


def check_shape(rows: FloatArray, channels: int) -> None:
    """Refuse rows that do not fit the channels.

    Raises:
        StoreValueError: not of shape (n, channels).
    """
    if rows.ndim != 2 or rows.shape[1] != channels:
        raise StoreValueError(f"rows have the shape {rows.shape}; wanted (any number, {channels}): one per channel")


def add_channels(connection: Connection, trial_id: int, channels: Mapping[str, FloatArray]) -> None:
    """Insert all rows of a trial that has none, from its channels in their order, each of shape (n,)."""
    columns = list(channels.values())
    for start in range(0, len(columns[0]), BLOCK_ROWS):
        part = slice(start, start + BLOCK_ROWS)
        add(connection, trial_id, start, np.column_stack([column[part] for column in columns]))


def _column(trial: Trial, channel: str) -> int:
    if channel not in trial.channels:
        raise NotFoundError(f"trial {trial.id} has no channel '{channel}'; it has {', '.join(trial.channels)}")
    return trial.channels.index(channel)
