"""The rows that a plot needs, of a whole trial or of a stretch of it. Works inside the caller's transaction.

Fewer rows are made by MinMaxLTTB (Van Der Donckt et al. 2023, arXiv 2305.00332): extremes are kept, so a spike of one
sample is still seen.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import Connection
from tsdownsample import MinMaxLTTBDownsampler

from bench.store.records import Trial
from bench.store.tables import samples
from bench.store.tables.plotted.overview import GROUP_ROWS
from compensator.lab.recordings.recording import FloatArray

MIN_POINTS = 4
_REDUCE: Any = MinMaxLTTBDownsampler()  # type: ignore[no-untyped-call]
GROUPS_PER_POINT = 1.5  # fewer, and a plot is made from all rows: MinMaxLTTB wants about two

Stretch = tuple[float, float]
"""From, to [s], in the trial's own time."""


def rows_to_keep(
    channels: dict[str, FloatArray], points: int, asked: Mapping[str, NDArray[np.bool_]] | None = None
) -> NDArray[np.intp]:
    """Indices of the rows that matter to any of the channels, rising.

    Each channel is reduced to `points` of its own, so up to points x channels rows may be kept. The
    rows on both sides of where a channel begins or ceases to be known (NaN) are kept too, as long as
    they are not more than `points`, so that a plot shows the gap.

    Args:
        channels: channel name -> samples, all of shape (n,). `time_s` asks for no rows of its own.
        points: at least `MIN_POINTS`.
        asked: for each channel the rows that matter to it at all, shape (n,), where that is known already.
    """
    rows = len(next(iter(channels.values()), ()))
    if rows <= points:
        return np.arange(rows)
    kept = np.zeros(rows, dtype=np.bool_)
    kept[[0, -1]] = True
    for name, values in channels.items():
        if name == "time_s":
            continue
        if asked is None:
            kept[_of_channel(values, points)] = True
        else:
            candidates = np.flatnonzero(asked[name])
            kept[candidates[_of_channel(values[candidates], points)]] = True
    return np.flatnonzero(kept)


def _of_channel(values: FloatArray, points: int) -> NDArray[np.intp]:
    unknown = np.isnan(values)
    if not unknown.any():
        return _of_known(values, points) if len(values) > points else np.arange(len(values))
    known = np.flatnonzero(~unknown)
    if len(known) <= points:
        return known
    before = np.flatnonzero(unknown[1:] != unknown[:-1])
    edges = np.concatenate([before, before + 1])
    kept = known[_of_known(np.ascontiguousarray(values[known]), points)]
    return np.concatenate([kept, edges]) if len(edges) <= points else kept


def _of_known(values: FloatArray, points: int) -> NDArray[np.intp]:
    chosen: NDArray[np.uint64] = _REDUCE.downsample(values, n_out=points)
    # MinMaxLTTB keeps the shape, but may drop the very highest or lowest sample
    return np.append(chosen.astype(np.intp), [values.argmin(), values.argmax()])


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
