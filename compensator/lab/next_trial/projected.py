"""What columns of effects leave once others are taken out, from normal equations alone."""

import numpy as np

from compensator.lab.recordings.recording import FloatArray, IntArray

NEGLIGIBLE = 1e-9  # share of the largest eigenvalue below which normal equations say nothing


class Projected:
    """Columns of effects once all that the base columns can make is taken out, by normal equations alone.

    Args:
        gram: of all columns, shape (K, K).
        base: columns that are taken out.
        first: the first column of an effect; the others follow it.
    """

    def __init__(self, gram: FloatArray, base: IntArray, first: int) -> None:
        inside = gram[np.ix_(base, base)]
        scale = np.sqrt(np.maximum(np.diag(inside), np.finfo(float).tiny))
        values, vectors = np.linalg.eigh(inside / np.outer(scale, scale))
        solid = values > NEGLIGIBLE * values[-1]
        share = (vectors[:, solid] / np.sqrt(values[solid])).T @ (gram[base, first:] / scale[:, None])
        self._gram: FloatArray = gram[first:, first:] - share.T @ share
        self._least: FloatArray = np.maximum(NEGLIGIBLE * np.diag(gram)[first:], np.finfo(float).tiny)

    def power(self, own: IntArray, amplitudes: FloatArray) -> float:
        """Of `own @ amplitudes`, what is left of it."""
        return max(float(amplitudes @ self._gram[np.ix_(own, own)] @ amplitudes), 0.0)

    def inverse(self, own: IntArray) -> FloatArray:
        """Inverse of what is left of the columns' normal equations; directions that they do not know are left out."""
        left = self._gram[np.ix_(own, own)]
        return np.linalg.pinv(left, rcond=NEGLIGIBLE, hermitian=True).astype(np.float64)

    def most_absorbed(self, shapes: IntArray, own: IntArray, amplitudes: FloatArray) -> float:
        """Power of the same that another effect explains at the best of its shapes, whose columns have shape (s, k)."""
        share = (self._gram[:, own] @ amplitudes)[shapes]
        if shapes.shape[1] == 1:
            columns = shapes[:, 0]
            left = np.diag(self._gram)[columns]
            return float(
                np.max(
                    np.where(
                        left > self._least[columns], share[:, 0] ** 2 / np.maximum(left, self._least[columns]), 0.0
                    )
                )
            )
        inside = self._gram[shapes[:, :, None], shapes[:, None, :]]
        scale = np.sqrt(np.maximum(np.diagonal(inside, axis1=1, axis2=2), self._least[shapes]))
        values, vectors = np.linalg.eigh(inside / (scale[:, :, None] * scale[:, None, :]))
        turned = np.einsum("skj,sk->sj", vectors, share / scale)
        explained = np.where(values > NEGLIGIBLE, turned**2 / np.maximum(values, NEGLIGIBLE), 0.0)
        return float(np.max(explained.sum(axis=1)))
