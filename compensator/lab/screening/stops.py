"""Static friction is another one after every stop, and stays what it is until the next: noise that lasts a stroke.

How long contacts rested, and where, makes static friction scatter by some percent from stop to stop (Armstrong, Dupont,
Canudas de Wit 1994). In slow motion it fades over seconds, so that a few strokes hold most of it; it is neither
stationary in time nor independent from one row to the next, and whatever differs between these strokes, as the load
and the temperature do, seems to explain it. So it is a random effect of its own in the noise (Laird, Ware 1982), and
evidence is weighed by what it leaves sure (generalised least squares: Aitken 1935).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import FloatArray, IntArray

VARIANCES = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, 61) ** 2])  # of the factor: none to all of it
MOST = 60  # strokes that the variance is learnt from, those with most static friction
NEGLIGIBLE = 1e-6  # share of the strokes' power: the base explains it


@dataclass(frozen=True)
class StopToStop:
    """The share of static friction in each row, by the stroke since the last stop.

    Attributes:
        share: weighted, in the effort's unit, shape (n,).
        index: stroke of each row, 0 .. S - 1, in the order of rows, shape (n,).
    """

    share: FloatArray
    index: IntArray

    @property
    def power(self) -> FloatArray:
        """Of each stroke's share, shape (S,)."""
        return np.bincount(self.index, self.share**2).astype(float)

    def scaled(self, values: FloatArray, factor: FloatArray) -> FloatArray:
        """Values (n, k) with what each stroke's share has of them times its factor, shape (S,)."""
        power = self.power
        change = (factor - 1.0) / np.where(power > 0.0, power, 1.0)
        found: FloatArray = values + self.share[:, None] * (change[:, None] * self.sums(values))[self.index]
        return found

    def evening(self, variance: float, covariance: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Factors that leave of each stroke's share as much noise as others rows have, shape (S,).

        Args:
            variance: of the factor of static friction.
            covariance: of the other noise in directions (n, k), shape (k, k).
        """
        columns, power = self._most()
        other = float(np.median(np.diag(covariance(columns / np.sqrt(power))))) if len(power) else 0.0
        if other <= 0.0:
            return np.ones_like(self.power)
        factor: FloatArray = 1.0 / np.sqrt(1.0 + variance * self.power / other)
        return factor

    def _most(self) -> tuple[FloatArray, FloatArray]:
        """The shares of the strokes that have most static friction, a column each (n, s), and their powers (s,)."""
        power = self.power
        most = np.argsort(-power, kind="stable")[:MOST]
        most = most[power[most] > 0.0]
        return np.where(self.index[:, None] == most, self.share[:, None], 0.0), power[most]

    def sums(self, directions: FloatArray) -> FloatArray:
        """What a stroke's share puts into each direction (n, k), shape (S, k)."""
        count = int(self.index.max()) + 1
        return np.column_stack([np.bincount(self.index, self.share * one, count) for one in directions.T])

    def variance(
        self, basis: FloatArray, residual: FloatArray, covariance: Callable[[FloatArray], FloatArray]
    ) -> float:
        """Of the factor of static friction from stop to stop: the likeliest of VARIANCES, beside other noise.

        Args:
            basis: of the model that left the residual, shape (n, b).
            residual: weighted, shape (n,).
            covariance: of the other noise in directions (n, k), shape (k, k).
        """
        columns, power = self._most()
        columns -= basis @ (basis.T @ columns)
        powers, axes = np.linalg.eigh(columns.T @ columns)
        solid = powers > NEGLIGIBLE * float(power.sum())
        if not solid.any():
            return 0.0
        powers = powers[solid]
        directions = columns @ (axes[:, solid] / np.sqrt(powers))
        other = np.maximum(np.diag(covariance(directions)), np.finfo(float).tiny)
        expected = other + VARIANCES[:, None] * powers
        likelihood = -0.5 * np.sum(np.log(expected) + (directions.T @ residual) ** 2 / expected, axis=1)
        return float(VARIANCES[int(np.argmax(likelihood))])
