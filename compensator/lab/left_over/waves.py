"""How much of what is left cosine and sine explain together, whatever the phase, by least squares (Lomb 1976)."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import BoolArray, FloatArray

APART = 1e-3  # of their powers: of less, cosine and sine can hardly be told from each other beside the model


@dataclass(frozen=True)
class Waves:
    """Cosines and sines beside a model, on white rows.

    Attributes:
        size: what each pair explains, chi-squared of two in noise alone, shape (m,); 0 where the two are not apart.
        whole: power of cosines, then of sines, shape (2, m).
        left: of the same beside the model.
    """

    size: FloatArray
    whole: FloatArray
    left: FloatArray

    @classmethod
    def of(cls, columns: FloatArray, basis: FloatArray, residual: FloatArray) -> "Waves":
        """Of white cosines, then sines (n, 2m), beside a basis (n, b), in a residual (n,)."""
        half = columns.shape[1] // 2
        taken = basis.T @ columns
        whole = np.einsum("nk,nk->k", columns, columns)
        left = whole - np.einsum("bk,bk->k", taken, taken)
        both = np.einsum("nk,nk->k", columns[:, :half], columns[:, half:])
        both -= np.einsum("bk,bk->k", taken[:, :half], taken[:, half:])
        (cosine, sine), (a, b) = np.split(residual @ columns, 2), np.split(left, 2)
        area = a * b - both**2
        apart = area > APART * a * b
        size = (b * cosine**2 - 2.0 * both * cosine * sine + a * sine**2) / np.where(apart, area, 1.0)
        return cls(np.where(apart, size, 0.0), whole.reshape(2, half), left.reshape(2, half))

    def where(self, told: BoolArray) -> FloatArray:
        """Their sizes; 0 where they are not told from the model, shape (m,)."""
        found: FloatArray = np.where(told, self.size, 0.0)
        return found
