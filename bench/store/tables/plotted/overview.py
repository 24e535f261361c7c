"""The overview of a trial: the few rows that a plot of all of it needs, kept beside the blocks.

Every `GROUP_ROWS` rows make a group. Of each group each channel asks for the rows with its lowest and its
highest sample, and for those on both sides of where it begins or ceases to be known. They are rows as
they were recorded: a spike of one sample is in the overview, and nothing is averaged.

This is the first half of MinMaxLTTB (Van Der Donckt et al. 2023, arXiv 2305.00332), done once, when the
rows are written; `reduction.py` does the other half when a plot is asked for.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from compensator.lab.recordings.recording import FloatArray

GROUP_ROWS = 512  # 2 million rows make 3 906 groups: about twice the points that a plot asks for
MOST_EDGES = 2  # in a group and channel; a channel that comes and goes with every row shows no gap anyway


class Overview(NamedTuple):
    """The overview of some rows of a trial, whole groups.

    Attributes:
        covered: how many rows it stands for.
        rows: which of them are kept, counted from the first one covered, rising; shape (k,).
        asked_by: for each of them the sum of 2**channel over the channels that asked for it; shape (k,).
        columns: those rows, shape (channels, k).
    """

    covered: int
    rows: NDArray[np.intp]
    asked_by: NDArray[np.int64]
    columns: FloatArray


def overview_of(columns: FloatArray) -> Overview:
    """The overview of rows; what does not fill a group is not covered.

    Args:
        columns: shape (channels, rows); at most 52 channels. The first one asks for nothing: it is the time.
    """
    covered = columns.shape[1] // GROUP_ROWS * GROUP_ROWS
    asked = np.zeros(covered, dtype=np.int64)
    for channel in range(1, columns.shape[0]):
        groups = columns[channel, :covered].reshape(-1, GROUP_ROWS)
        asked[_rows_of(groups)] |= 1 << channel
    if covered:
        asked[[0, -1]] |= asked_by_all(columns.shape[0])
    rows = np.flatnonzero(asked)
    return Overview(covered, rows, asked[rows], columns[:, rows])


def asked_by_all(channels: int) -> int:
    """The number that stands for all channels."""
    return (1 << channels) - 1


def asked_by(channel: int, numbers: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether a channel asked for each row."""
    found: NDArray[np.bool_] = (numbers >> channel) & 1 == 1
    return found


def _rows_of(groups: FloatArray) -> NDArray[np.intp]:
    """The rows that a channel asks for; some of them twice."""
    starts = np.arange(0, groups.size, GROUP_ROWS)
    lowest, highest = groups.argmin(axis=1), groups.argmax(axis=1)
    # argmin finds the first NaN where there is one
    if not np.isnan(groups[np.arange(len(groups)), lowest]).any():
        return np.concatenate([starts + lowest, starts + highest])
    unknown = np.isnan(groups)
    some = ~unknown.all(axis=1)
    lowest = np.where(unknown, np.inf, groups).argmin(axis=1)
    highest = np.where(unknown, -np.inf, groups).argmax(axis=1)
    flat = unknown.reshape(-1)
    before = np.flatnonzero(flat[1:] != flat[:-1])  # the row before each edge; edges between two groups too
    counts = np.bincount(before // GROUP_ROWS, minlength=len(starts))
    few = before[counts[before // GROUP_ROWS] <= MOST_EDGES]
    return np.concatenate([(starts + lowest)[some], (starts + highest)[some], few, few + 1])
