"""What is another one in each trial, or after each stop, and the same until the next: part of the noise.

Dry friction differs from trial to trial, and how long contacts rested, and where, makes static friction scatter by some
percent from stop to stop (Armstrong, Dupont, Canudas de Wit 1994). Neither is stationary in time nor independent from
one row to the next, and whatever differs between these trials, or a few slow strokes, as the load and the temperature
do, seems to explain it. So each is a random effect in the noise (Laird, Ware 1982).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.screening.base import Base

VARIANCES = np.geomspace(1e-3, 10.0, 81) ** 2  # of the factor
MOST = 24  # groups that the variance is learnt from, those with most
TINY = float(np.finfo(float).tiny)
NEGLIGIBLE = 1e-6  # share of their power: the base explains it


@dataclass(frozen=True)
class RandomEffect:
    """A share of the effort that has another factor in each group of rows.

    Attributes:
        share: weighted, in the effort's unit, shape (n,).
        group: of each row, 0 .. G - 1, shape (n,).
        variance: of the factor.
        freedom: of how many squares the variance is known as well; 0 where it is not.
    """

    share: FloatArray
    group: IntArray
    variance: float = 0.0
    freedom: float = 0.0

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

    def power(self, rows: slice, directions: FloatArray) -> FloatArray:
        """What it adds to the variance of what some rows have in directions (m, k), shape (k,)."""
        _, group = np.unique(self.group[rows], return_inverse=True)
        each = np.zeros((int(group.max(initial=-1)) + 1, directions.shape[1]))
        np.add.at(each, group, directions * self.share[rows, None])
        found: FloatArray = self.variance * np.sum(each**2, axis=0)
        return found

    def learnt(self, left: Base, power: Callable[[FloatArray], FloatArray]) -> "RandomEffect":
        """With its variance, and how well that is known, beside other noise.

        Each deviation is as likely beforehand (Gelman 2006). What the groups make of them has a mean and a spread, as a
        scaled inverse chi-squared variable of so many degrees of freedom has: few groups, or none that stands out of
        the other noise, tell no variance, and not that there is none.

        Args:
            left: the model, and what it left.
            power: of the other noise in directions (n, k), shape (k,).
        """
        whole = self.columns()
        columns = left.beyond(whole)
        powers, axes = np.linalg.eigh(columns.T @ columns)
        solid = powers > NEGLIGIBLE * max(float(np.sum(whole**2)), TINY)
        if not solid.any():
            return self
        powers = powers[solid]
        directions = columns @ (axes[:, solid] / np.sqrt(powers))
        expected = np.maximum(power(directions), TINY) + VARIANCES[:, None] * powers
        likelihood = -0.5 * np.sum(np.log(expected) + (directions.T @ left.residual) ** 2 / expected, axis=1)
        chance = np.sqrt(VARIANCES) * np.exp(likelihood - likelihood.max())
        mean = float(chance @ VARIANCES / chance.sum())
        spread = float(chance @ (VARIANCES - mean) ** 2 / chance.sum())
        freedom = 4.0 + min(2.0 * mean**2 / max(spread, TINY), len(powers))
        return replace(self, variance=mean * (freedom - 2.0) / freedom, freedom=freedom)
