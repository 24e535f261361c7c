"""Weights of rows: near reversals, at large acceleration and jerk, and where a model bends, residuals are larger."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.dataset import Dataset

BINS = 4
NORMAL = 1.4826  # standard deviation over median absolute deviation
OUTLYING = 4.0  # standard deviations: one row in 16,000 of noise
TINY = float(np.finfo(float).tiny)
LIMITS = (0.3, 3.0)  # a weight never says that a row is ten times better than another
BENDS = np.array([0.3, 0.5, 0.7, 0.9])  # of `Dataset.steadiness`, between classes; the last one hardly bends
DRAWN = 20.0  # rows by which a class of few is drawn to what all have


@dataclass(frozen=True)
class RowWeights:
    """How much rows of each kind scatter, as learnt from some and applied to any.

    Attributes:
        edges: between bins of acceleration and of jerk, shape (2, BINS - 1).
        factor: weight of each bin, shape (2 * BINS * BINS,).
        bent: weight, at most 1, of each class of rows where the model bends, shape (len(BENDS) + 1,).
    """

    edges: FloatArray
    factor: FloatArray
    bent: FloatArray

    @classmethod
    def learnt(cls, dataset: Dataset, residual: FloatArray, rows: BoolArray) -> "RowWeights":
        """From the residual (N,) of the chosen rows (N,): the weighted residual has the same variance everywhere.

        A model that bends (see `Dataset.steadiness`) determines some rows not at all, as a dead time does where hardly
        any current flows. How much less is learnt from what it leaves there, since its own bend says only how errors
        are multiplied.
        """
        sizes = _sizes(dataset, rows)
        edges = np.array([np.quantile(size, np.linspace(0.0, 1.0, BINS + 1)[1:-1]) for size in sizes])
        bins, bends = _bins(dataset, rows, sizes, edges), _bends(dataset, rows)
        chosen = dataset.steadiness[rows] * residual[rows]
        straightest = int(bends.max(initial=0))
        known = bends == straightest
        variance = _variances(chosen[known], bins[known], 2 * BINS * BINS)
        factor = 1.0 / np.sqrt(np.maximum(variance, TINY))
        factor = np.clip(factor / np.median(factor[bins]), *LIMITS)
        variance = _variances(factor[bins] * chosen, bends, len(BENDS) + 1)
        least = max(float(variance[straightest]), TINY)
        bent = np.sqrt(least / np.maximum(variance, least))
        return cls(edges, factor, bent)

    def of(self, dataset: Dataset, rows: BoolArray) -> FloatArray:
        """Factors for the chosen rows of any dataset, shape (rows.sum(),), beside their steadiness."""
        bins = _bins(dataset, rows, _sizes(dataset, rows), self.edges)
        factors: FloatArray = self.factor[bins] * self.bent[_bends(dataset, rows)]
        return factors

    def determined(self, dataset: Dataset, rows: BoolArray) -> FloatArray:
        """How well the model determines the effort of each chosen row, at most 1, its steadiness included."""
        found: FloatArray = dataset.steadiness[rows] * self.bent[_bends(dataset, rows)]
        return found


def weights_of(fit: Fit, rows: BoolArray, residual: FloatArray) -> FloatArray:
    """Factors for the chosen rows, shape (rows.sum(),): residuals so weighted have like variance, median 1.

    How much rows of each kind scatter, and how well the model determines them, is learnt from the rows that the model
    was fitted to. No row pulls harder than one of OUTLYING standard deviations (Huber 1964): a tooth that bounces off
    its neighbour moves a row by tens of them, and says nothing of the effects looked for.

    Args:
        fit: of the model.
        rows: chosen, shape (N,).
        residual: of the chosen rows, shape (rows.sum(),).
    """
    learnt = RowWeights.learnt(fit.dataset, fit.residual, fit.training)
    weights = learnt.of(fit.dataset, rows) * fit.dataset.steadiness[rows]
    found: FloatArray = weights * bounded_influence(residual * weights)
    return found


def bounded_influence(residual: FloatArray) -> FloatArray:
    """Factors of at most 1, shape (n,), by which no residual (n,) is beyond OUTLYING standard deviations."""
    size = np.abs(residual)
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


def _bends(dataset: Dataset, rows: BoolArray) -> IntArray:
    """Class of each chosen row by how much the model bends there, len(BENDS) where it hardly does."""
    found: IntArray = np.searchsorted(BENDS, dataset.steadiness[rows])
    return found


def _variances(residual: FloatArray, bins: IntArray, count: int) -> FloatArray:
    """Mean square in each bin, shape (count,): one with few rows is drawn to that of all."""
    rows = np.bincount(bins, minlength=count)
    power = np.bincount(bins, weights=residual**2, minlength=count)
    overall = float(np.mean(residual**2)) if len(residual) else 0.0
    found: FloatArray = (power + DRAWN * overall) / (rows + DRAWN)
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
