"""Weights of rows: near reversals, and where acceleration and jerk are large, residuals are larger."""

import numpy as np

from compensator.lab.dataset import Dataset
from compensator.lab.recording import FloatArray
from compensator.lab.regimes import BoolArray, Regime

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
    bins = 2 * bins + (dataset.regime[rows] != Regime.SLIDING)
    chosen = residual[rows]
    overall = float(np.mean(chosen**2))
    count = np.bincount(bins, minlength=2 * BINS * BINS)
    power = np.bincount(bins, weights=chosen**2, minlength=2 * BINS * BINS)
    variance = (power + 20.0 * overall) / (count + 20.0)  # a bin with few rows is drawn to the overall variance
    factor = 1.0 / np.sqrt(np.maximum(variance[bins], np.finfo(float).tiny))
    weights: FloatArray = np.clip(factor / np.median(factor), *LIMITS)
    return weights


def regime_weights(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> FloatArray:
    """Factors for all rows, shape (N,): 1 while sliding, less near reversals by how much larger residuals are there.

    Args:
        dataset: of the rows.
        residual: of all rows, of a model fitted to sliding rows, shape (N,).
        rows: that are to be fitted, shape (N,).
    """
    sliding = dataset.regime == Regime.SLIDING
    power = [float(np.mean(residual[rows & side] ** 2)) for side in (sliding, ~sliding)]
    factor = np.sqrt(power[0] / power[1]) if power[1] > 0.0 else 1.0
    weights: FloatArray = np.where(sliding, 1.0, np.clip(factor, 1.0 / LIMITS[1], 1.0))
    return weights
