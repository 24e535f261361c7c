"""Weights of rows: where acceleration and jerk are large, position errors are magnified and residuals are larger."""

import numpy as np

from compensator.lab.dataset import Dataset
from compensator.lab.recording import FloatArray
from compensator.lab.regimes import BoolArray

BINS = 4
LIMITS = (0.3, 3.0)  # a weight never says that a row is ten times better than another


def row_weights(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> FloatArray:
    """Factors for the chosen rows, shape (rows.sum(),), median 1; residuals so weighted have like variance.

    Args:
        dataset: of the rows.
        residual: of all rows, shape (N,).
        rows: chosen, shape (N,).
    """
    bins = np.zeros(int(rows.sum()), dtype=np.int64)
    motions = [trial.motion for trial in dataset.trials]
    for magnified in ([m.acceleration for m in motions], [m.jerk for m in motions]):
        size = np.abs(dataset.rows_of(magnified))[rows]
        edges = np.quantile(size, np.linspace(0.0, 1.0, BINS + 1)[1:-1])
        bins = bins * BINS + np.searchsorted(edges, size)
    chosen = residual[rows]
    overall = float(np.mean(chosen**2))
    count = np.bincount(bins, minlength=BINS * BINS)
    power = np.bincount(bins, weights=chosen**2, minlength=BINS * BINS)
    variance = (power + 20.0 * overall) / (count + 20.0)  # a bin with few rows is drawn to the overall variance
    factor = 1.0 / np.sqrt(np.maximum(variance[bins], np.finfo(float).tiny))
    weights: FloatArray = np.clip(factor / np.median(factor), *LIMITS)
    return weights
