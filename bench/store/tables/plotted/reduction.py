"""Fewer rows for a plot: MinMaxLTTB (Van Der Donckt et al. 2023, arXiv 2305.00332).

Extremes are kept, so a spike of one sample is still seen.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tsdownsample import MinMaxLTTBDownsampler

from compensator.lab.recordings.recording import FloatArray

MIN_POINTS = 4
_REDUCE: Any = MinMaxLTTBDownsampler()  # type: ignore[no-untyped-call]


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
