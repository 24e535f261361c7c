"""Fewer rows for a plot: MinMaxLTTB (Van Der Donckt et al. 2023, arXiv 2305.00332).

Extremes are kept, so a spike of one sample is still seen.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from tsdownsample import MinMaxLTTBDownsampler

from compensator.lab.recording import FloatArray

MIN_POINTS = 4
_REDUCE: Any = MinMaxLTTBDownsampler()  # type: ignore[no-untyped-call]


def rows_to_keep(channels: dict[str, FloatArray], points: int) -> NDArray[np.intp]:
    """Indices of the rows that matter to any of the channels, rising.

    Each channel is reduced to `points` of its own, so up to points x channels rows may be kept. The
    rows on both sides of where a channel begins or ceases to be known (NaN) are kept too, as long as
    they are not more than `points`, so that a plot shows the gap.

    Args:
        channels: channel name -> samples, all of shape (n,). `time_s` asks for no rows of its own.
        points: at least `MIN_POINTS`.
    """
    rows = len(next(iter(channels.values()), ()))
    if rows <= points:
        return np.arange(rows)
    ends = np.array([0, rows - 1])
    kept = [_of_channel(values, points) for name, values in channels.items() if name != "time_s"]
    return np.unique(np.concatenate([ends, *kept]))


def _of_channel(values: FloatArray, points: int) -> NDArray[np.intp]:
    known = np.flatnonzero(~np.isnan(values))
    if len(known) <= points:
        return known
    before = np.flatnonzero(np.diff(np.isnan(values)))
    edges = np.concatenate([before, before + 1])
    chosen: NDArray[np.uint64] = _REDUCE.downsample(np.ascontiguousarray(values[known]), n_out=points)
    # MinMaxLTTB keeps the shape, but may drop the very highest or lowest sample
    extremes = known[[int(np.argmin(values[known])), int(np.argmax(values[known]))]]
    kept = np.union1d(known[chosen.astype(np.intp)], extremes)
    return np.union1d(kept, edges) if len(edges) <= points else kept
