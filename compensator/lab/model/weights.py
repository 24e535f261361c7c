"""Weights of rows: near reversals, and where acceleration and jerk are large, residuals are larger."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.regimes import BoolArray, Regime
from compensator.lab.rows.dataset import Dataset, IntArray

BINS = 4
NORMAL = 1.4826  # standard deviation over median absolute deviation
OUTLYING = 4.0  # standard deviations: one row in 16,000 of noise
TINY = float(np.finfo(float).tiny)
LIMITS = (0.3, 3.0)  # a weight never says that a row is ten times better than another


@dataclass(frozen=True)
class RowWeights:
    """How much rows of each kind scatter, as learnt from some and applied to any.

    Attributes:
        edges: between bins of acceleration and of jerk, shape (2, BINS - 1).
        factor: weight of each bin, shape (2 * BINS * BINS,).
    """

    edges: FloatArray
    factor: FloatArray

    @classmethod
    def learnt(cls, dataset: Dataset, residual: FloatArray, rows: BoolArray) -> "RowWeights":
        """From the residual (N,) of the chosen rows (N,): the weighted residual has the same variance everywhere."""
        sizes = _sizes(dataset, rows)
        edges = np.array([np.quantile(size, np.linspace(0.0, 1.0, BINS + 1)[1:-1]) for size in sizes])
        bins = _bins(dataset, rows, sizes, edges)
        chosen = residual[rows]
        overall = float(np.mean(chosen**2))
        count = np.bincount(bins, minlength=2 * BINS * BINS)
        power = np.bincount(bins, weights=chosen**2, minlength=2 * BINS * BINS)
        variance = (power + 20.0 * overall) / (count + 20.0)  # a bin with few rows is drawn to the overall variance
        factor = 1.0 / np.sqrt(np.maximum(variance, np.finfo(float).tiny))
        return cls(edges, np.clip(factor / np.median(factor[bins]), *LIMITS))

    def of(self, dataset: Dataset, rows: BoolArray) -> FloatArray:
        """Factors for the chosen rows of any dataset, shape (rows.sum(),)."""
        factors: FloatArray = self.factor[_bins(dataset, rows, _sizes(dataset, rows), self.edges)]
        return factors


def row_weights(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> FloatArray:
    """Factors for the chosen rows, shape (rows.sum(),), median 1; residuals so weighted have like variance.

    Args:
        dataset: of the rows.
        residual: of all rows, shape (N,).
        rows: chosen, shape (N,).
    """
    return RowWeights.learnt(dataset, residual, rows).of(dataset, rows)


def bounded_influence(residual: FloatArray, weights: FloatArray) -> FloatArray:
    """Factors of at most 1, shape (n,): no row pulls harder than one of OUTLYING standard deviations (Huber 1964).

    A tooth that bounces off its neighbour moves a row by tens of them, and says nothing of the effects looked for.

    Args:
        residual: of the rows, shape (n,).
        weights: of the same rows, shape (n,).
    """
    size = np.abs(residual * weights)
    most = OUTLYING * NORMAL * float(np.median(size))
    factors: FloatArray = max(most, TINY) / np.maximum(size, max(most, TINY))
    return factors


def _sizes(dataset: Dataset, rows: BoolArray) -> list[FloatArray]:
    """Acceleration and jerk of the chosen rows, without their sign."""
    motions = [trial.motion for trial in dataset.trials]
    stacked = [[m.acceleration for m in motions], [m.jerk for m in motions]]
    return [np.abs(dataset.rows_of(values))[rows] for values in stacked]


def _bins(dataset: Dataset, rows: BoolArray, sizes: list[FloatArray], edges: FloatArray) -> IntArray:
    bins = np.zeros(int(rows.sum()), dtype=np.int64)
    for size, between in zip(sizes, edges, strict=True):
        bins = bins * BINS + np.searchsorted(between, size)
    found: IntArray = 2 * bins + (dataset.regime[rows] != Regime.SLIDING)
    return found


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
