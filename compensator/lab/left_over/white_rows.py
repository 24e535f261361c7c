"""What a model leaves on rows whitened by the noise, and how surely columns explain it."""

from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.model.linear import orthonormal
from compensator.lab.model.weights import NORMAL
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates, noise_of
from compensator.lab.screening.noise import SHRINK_ROWS, Noise
from compensator.lab.screening.whitening import Whitening

FORETOLD = 20.0  # evidence, as 2 ln L, of what all other stretches foretell of each, the best one left out
LOOK_AGAIN = 0.01  # chance in noise that is learnt with what may be there, and so hides it
ENDS = 3  # rows at the ends of strokes, each a kind of its own
OUTLYING = 2.5  # standard deviations: one row in eighty of noise
NEGLIGIBLE = 1e-8  # share of a direction in what columns explain


def _at_ends(noise: Noise, residual: FloatArray) -> FloatArray:
    """Factors (n,) that bring rows at the ends of strokes to the variance of others, where they have more.

    The filter brings to them what a reversal does, in the same way in every trial of one motion.
    """
    left = [_left_of_run(place.grid) for place in noise.places]
    kind = np.minimum(np.concatenate(left), ENDS)
    count = np.bincount(kind, minlength=ENDS + 1)
    power = np.bincount(kind, residual**2, ENDS + 1)
    usual = power[ENDS] / max(count[ENDS], 1) or 1.0
    variance = (power / usual + SHRINK_ROWS) / (count + SHRINK_ROWS)
    factors: FloatArray = 1.0 / np.sqrt(np.maximum(variance, 1.0))[kind]
    return factors


def _left_of_run(grid: IntArray) -> IntArray:
    """How many rows lie between each row and the nearer end of its run without gaps, shape (n,)."""
    ends = np.flatnonzero(np.diff(grid) != 1)
    starts, stops = np.append(0, ends + 1), np.append(ends, len(grid) - 1)
    run = np.searchsorted(stops, np.arange(len(grid)))
    place = np.arange(len(grid))
    found: IntArray = np.minimum(place - starts[run], stops[run] - place)
    return found


def _bounded(residual: FloatArray) -> FloatArray:
    """A whitened residual (n,) whose rows each hold no more than OUTLYING: what comes at the ends of strokes is wild.

    A few rows that a reversal reaches through the filter have so much, in the same way in every trial, that they alone
    would make a curve (score test of bounded influence: Huber 1981).
    """
    most = OUTLYING * max(1.0, NORMAL * float(np.median(np.abs(residual))))
    return np.clip(residual, -most, most)


@dataclass(frozen=True)
class WhiteRows:
    """Rows of unit noise.

    Attributes:
        noise: that a complete model would leave.
        whitening: of weighted rows.
        stretch: of each row, 0 .. S - 1, shape (n,).
        basis: orthonormal, of what the model explains, whitened, shape (n, b).
        residual: that it leaves, whitened, shape (n,).
    """

    noise: Noise
    whitening: Whitening
    stretch: IntArray
    basis: FloatArray
    residual: FloatArray

    @classmethod
    def of(cls, gathered: Candidates) -> "WhiteRows | None":
        """The tested rows on top of all that the chain can produce; None where the noise is not known."""
        return None if gathered.noise is None else cls._made(gathered, gathered.noise)

    def cleared(self, gathered: Candidates, columns: FloatArray) -> "WhiteRows":
        """The same rows, of noise that columns (n, k) have no part in: weighted ones, as they were measured."""
        plain = replace(gathered, bases=[gathered.as_measured(WITH_CHAIN)])
        return self._made(gathered, noise_of(plain, replace(plain, bases=[plain.bases[0].extended(columns)])))

    @classmethod
    def _made(cls, gathered: Candidates, noise: Noise) -> "WhiteRows":
        base = gathered.as_measured(WITH_CHAIN)
        whitening = Whitening.of(noise)
        wild = _at_ends(noise, whitening.whitened(base.residual[:, None])[:, 0])
        whitening = whitening.scaled(wild)
        white = whitening.whitened(np.column_stack([base.basis, base.residual]))
        basis = orthonormal(white[:, :-1])
        residual = _bounded(white[:, -1] - basis @ (basis.T @ white[:, -1]))
        residual -= basis @ (basis.T @ residual)
        _, stretch = np.unique(gathered.fit.dataset.block_index[gathered.rows], return_inverse=True)
        return cls(noise, whitening, stretch.reshape(-1), basis, residual)

    def beside(self, columns: FloatArray) -> FloatArray:
        """Weighted columns (n, k), whitened, without what the model explains of them."""
        columns = self.whitening.whitened(columns)
        left: FloatArray = columns - self.basis @ (self.basis.T @ columns)
        return left

    def foretold(self, columns: FloatArray) -> tuple[FloatArray, float]:
        """Coefficients of columns (n, k) beside the model; their evidence in each stretch by those of all others.

        The evidence of coefficients c in a stretch is 2 c's - c'Nc, of its scores s and normal matrix N. The best
        stretch is left out: what is in one alone may be of that moment.
        """
        count, size = int(self.stretch.max()) + 1, columns.shape[1]
        scores = np.array([np.bincount(self.stretch, one * self.residual, count) for one in columns.T]).T
        products = (columns[:, :, None] * columns[:, None, :]).reshape(-1, size**2)
        normal = np.array([np.bincount(self.stretch, one, count) for one in products.T]).T.reshape(-1, size, size)
        whole, sums = normal.sum(axis=0), scores.sum(axis=0)
        others = (np.linalg.pinv(whole - normal, rcond=NEGLIGIBLE) @ (sums - scores)[:, :, None])[:, :, 0]
        evidence = 2.0 * np.sum(others * scores, axis=1) - np.einsum("si,sij,sj->s", others, normal, others)
        coefficients: FloatArray = np.linalg.pinv(whole, rcond=NEGLIGIBLE) @ sums
        return coefficients, float(evidence.sum() - evidence.max())
