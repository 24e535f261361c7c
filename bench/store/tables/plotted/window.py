"""The rows that a plot needs, of a whole trial or of a stretch of it. Works inside the caller's transaction."""

from collections.abc import Sequence

import numpy as np
from sqlalchemy import Connection

from bench.store.records import Trial
from bench.store.tables import samples
from bench.store.tables.plotted.overview import GROUP_ROWS
from bench.store.tables.plotted.reduction import rows_to_keep
from compensator.lab.recordings.recording import FloatArray

GROUPS_PER_POINT = 1.5  # fewer, and a plot is made from all rows: MinMaxLTTB wants about two

Stretch = tuple[float, float]
"""From, to [s], in the trial's own time."""


def reduced(
    connection: Connection, trial: Trial, names: Sequence[str], points: int, between_s: Stretch | None
) -> dict[str, FloatArray]:
    """Channel name -> samples of the rows that matter, each of shape (k,).

    Args:
        connection: inside a transaction.
        trial: whose rows.
        names: of the channels, `time_s` among them.
        points: rows that each channel may ask for.
        between_s: the stretch; None for all of the trial. One row more on both sides comes along.

    Raises:
        NotFoundError: a channel that the trial does not have.
    """
    first, last = (0, trial.rows) if between_s is None else _rows_of(connection, trial, between_s)
    if last - first >= GROUPS_PER_POINT * points * GROUP_ROWS:
        found, asked = samples.read_overview(connection, trial, names)
        if between_s is not None:
            inside = (found["time_s"] >= between_s[0]) & (found["time_s"] <= between_s[1])
            found, asked = ({name: one[inside] for name, one in each.items()} for each in (found, asked))  # type: ignore[assignment]
        rows = rows_to_keep(found, points, asked)
    else:
        found = _read(connection, trial, names, first, last)
        rows = rows_to_keep(found, points)
    return {name: values[rows] for name, values in found.items()}


def _read(connection: Connection, trial: Trial, names: Sequence[str], first: int, last: int) -> dict[str, FloatArray]:
    if (first, last) == (0, trial.rows):
        return samples.read(connection, trial, names)
    part = samples.read_part(connection, trial, first, last - first)
    return {name: part[samples.column_of(trial, name)] for name in names}


def _rows_of(connection: Connection, trial: Trial, between_s: Stretch) -> tuple[int, int]:
    first, last = (_first_from(connection, trial, time_s) for time_s in between_s)
    return max(0, first - 1), min(trial.rows, last + 1)


def _first_from(connection: Connection, trial: Trial, time_s: float) -> int:
    """The first row at or after a time: time rises, so a few blocks are enough to find it."""
    time = samples.column_of(trial, "time_s")
    low, high = 0, trial.rows
    while low < high:
        middle = (low + high) // 2
        rows = samples.read_part(connection, trial, middle, min(samples.BLOCK_ROWS, high - middle))[time]
        if rows[-1] < time_s:
            low = middle + len(rows)
        elif rows[0] >= time_s:
            high = middle
        else:
            return middle + int(np.searchsorted(rows, time_s))
    return low
