"""Binned means with block-resampled bars: a residual against a driving variable, an effect's curve over it."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import FloatArray, IntArray

BINS = 24
FEWEST_PER_BIN = 5
SIGMAS = 2.0


@dataclass(frozen=True)
class BinnedMean:
    """Mean of a value in bins of another. Arrays have shape (bins,).

    Attributes:
        x: mean of the driving variable in the bin.
        mean: of the value.
        low, high: two standard errors, from the scatter between stretches, not between rows.
        count: rows in the bin.
    """

    x: FloatArray
    mean: FloatArray
    low: FloatArray
    high: FloatArray
    count: IntArray


def binned_mean(driver: FloatArray, values: FloatArray, stretch: IntArray) -> BinnedMean:
    """Bin rows by quantiles of the driver.

    Args:
        driver: what is binned, shape (n,).
        values: what is averaged, shape (n,).
        stretch: independent stretch of each row, shape (n,).
    """
    edges = np.unique(np.quantile(driver, np.linspace(0.0, 1.0, BINS + 1)))
    label = np.clip(np.searchsorted(edges, driver, side="right") - 1, 0, max(len(edges) - 2, 0))
    rows = []
    for index in np.unique(label):
        inside = label == index
        count = int(inside.sum())
        if count < FEWEST_PER_BIN:
            continue
        mean = float(values[inside].mean())
        half = SIGMAS * _standard_error(values[inside] - mean, stretch[inside])
        rows.append((float(driver[inside].mean()), mean, mean - half, mean + half, count))
    table = np.array(rows, dtype=float).reshape(-1, 5)
    return BinnedMean(table[:, 0], table[:, 1], table[:, 2], table[:, 3], table[:, 4].astype(np.int64))


def _standard_error(centred: FloatArray, stretch: IntArray) -> float:
    """Of a mean over clustered rows: the clusters' sums are independent, the rows are not."""
    _, dense = np.unique(stretch, return_inverse=True)
    sums = np.bincount(dense, weights=centred)
    clusters = len(sums)
    inflation = clusters / (clusters - 1.0) if clusters > 1 else 1.0
    between = float(np.sqrt(inflation * np.sum(sums**2))) / len(centred)
    within = float(np.std(centred)) / np.sqrt(len(centred))
    return float(max(between, within))
