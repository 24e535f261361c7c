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
    label = bins_of(driver)
    count = np.bincount(label)
    rows = np.maximum(count, 1)
    x, mean = np.bincount(label, driver) / rows, np.bincount(label, values) / rows
    half = SIGMAS * _standard_errors(label, values - mean[label], stretch, rows)
    shown = count >= FEWEST_PER_BIN
    return BinnedMean(x[shown], mean[shown], (mean - half)[shown], (mean + half)[shown], count[shown])


def bins_of(driver: FloatArray) -> IntArray:
    """Which bin each row is in, by quantiles of the driver, shape (n,)."""
    edges = np.unique(np.quantile(driver, np.linspace(0.0, 1.0, BINS + 1)))
    return np.clip(np.searchsorted(edges, driver, side="right") - 1, 0, max(len(edges) - 2, 0))


def _standard_errors(label: IntArray, centred: FloatArray, stretch: IntArray, rows: IntArray) -> FloatArray:
    """Of each bin's mean over clustered rows: the clusters' sums are independent, the rows are not; shape (bins,)."""
    _, own = np.unique(stretch, return_inverse=True)
    stretches = int(own.max()) + 1
    clusters, own = np.unique(label * stretches + own, return_inverse=True)
    bins = clusters // stretches
    count = np.bincount(bins, minlength=len(rows))
    powers = np.bincount(bins, np.bincount(own, centred) ** 2, len(rows))
    between: FloatArray = np.sqrt(powers * count / np.maximum(count - 1, 1)) / rows
    return np.maximum(between, np.sqrt(np.bincount(label, centred**2)) / rows)
