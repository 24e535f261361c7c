"""Candidate columns, and what they are judged on top of."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import Shape
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray

HYSTERESIS_DRIVER = "since_reversal"


@dataclass(frozen=True)
class Block:
    """Candidate columns and what they stand for.

    Attributes:
        name: of the effect.
        columns: over the rows tested, shape (n, k).
        base: index of the base it is judged against (see `Base`).
        scanned: how many shapes of the effect are scanned.
        shape: of the effect; empty of one without, and of a free curve.
    """

    name: str
    columns: FloatArray
    base: int
    scanned: int
    shape: Shape = ()


@dataclass(frozen=True)
class Base:
    """What every candidate is judged on top of: an orthonormal basis (n, b) and the weighted residual (n,)."""

    basis: FloatArray
    residual: FloatArray

    @classmethod
    def of(cls, columns: FloatArray, effort: FloatArray) -> "Base":
        """Project effort (n,) out of columns (n, k)."""
        basis = orthonormal(columns)
        return cls(basis, effort - basis @ (basis.T @ effort))

    def coefficients(self, columns: FloatArray) -> FloatArray:
        """Of columns (n, k), fitted freely on top of the base, shape (k,)."""
        found: FloatArray = np.linalg.lstsq(self.beyond(columns), self.residual, rcond=1e-6)[0].astype(np.float64)
        return found

    def beyond(self, columns: FloatArray) -> FloatArray:
        """What columns (n, k) have beyond the base, (n, k)."""
        rest: FloatArray = columns - self.basis @ (self.basis.T @ columns)
        return rest

    def extended(self, columns: FloatArray) -> "Base":
        """The base with columns (n, k) beside its own."""
        added = orthonormal(self.beyond(self.beyond(columns)))  # twice is enough (Kahan, Parlett)
        residual = self.residual - added @ (added.T @ self.residual)
        return Base(np.column_stack([self.basis, added]), residual)
