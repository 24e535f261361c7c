"""What is another one in each trial, or after each stop, and the same until the next: part of the noise.

Dry friction differs from trial to trial, and how long contacts rested, and where, makes static friction scatter by some
percent from stop to stop (Armstrong, Dupont, Canudas de Wit 1994). Neither is stationary in time nor independent from
one row to the next, and whatever differs between these trials, or a few slow strokes, as the load and the temperature
do, seems to explain it. So each is a random effect in the noise (Laird, Ware 1982).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.screening.base import Base

VARIANCES = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, 61) ** 2])  # of the factor: none to all of it
MOST = 24  # groups that the variance is learnt from, those with most
NEGLIGIBLE = 1e-6  # share of their power: the base explains it


@dataclass(frozen=True)
class RandomEffect:
    """A share of the effort that has another factor in each group of rows.

    Attributes:
        share: weighted, in the effort's unit, shape (n,).
        group: of each row, 0 .. G - 1, shape (n,).
        variance: of the factor.
    """

    share: FloatArray
    group: IntArray
    variance: float = 0.0

    def columns(self) -> FloatArray:
        """The shares of the groups that have most, a column each, shape (n, up to MOST)."""
        power = np.bincount(self.group, self.share**2)
        most = np.argsort(-power, kind="stable")[:MOST]
        return np.where(self.group[:, None] == most[power[most] > 0.0], self.share[:, None], 0.0)

    def covariance(self, rows: slice) -> FloatArray:
        """What it adds to that of some rows, shape (m, m)."""
        share, group = self.share[rows], self.group[rows]
        found: FloatArray = self.variance * np.equal.outer(group, group) * np.outer(share, share)
        return found


def likeliest_variance(columns: FloatArray, left: Base, power: Callable[[FloatArray], FloatArray]) -> float:
    """Of a factor of columns: the likeliest of VARIANCES, beside other noise.

    Args:
        columns: of each group, shape (n, g).
        left: the model, and what it left.
        power: of the other noise in directions (n, k), shape (k,).
    """
    columns = left.beyond(columns)
    powers, axes = np.linalg.eigh(columns.T @ columns)
    solid = powers > NEGLIGIBLE * max(float(powers.sum()), np.finfo(float).tiny)
    if not solid.any():
        return 0.0
    powers = powers[solid]
    directions = columns @ (axes[:, solid] / np.sqrt(powers))
    expected = np.maximum(power(directions), np.finfo(float).tiny) + VARIANCES[:, None] * powers
    likelihood = -0.5 * np.sum(np.log(expected) + (directions.T @ left.residual) ** 2 / expected, axis=1)
    return float(VARIANCES[int(np.argmax(likelihood))])
