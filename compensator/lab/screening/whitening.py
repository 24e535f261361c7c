"""Rows turned so that noise is the same in all of them, and independent: least squares on them is generalised ones.

Where many directions are compared, as the orders of a periodogram are, each one's own covariance would cost too much;
whitened once, rows are compared like any others (Aitken 1935).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.noise import Noise, spectral_density

MOST_ROWS = 200  # of a trial that are whitened together: longer ones in pieces, whose borders count for little
LEAST_POWER = 0.1  # of a direction's noise over the mean: where a filter leaves next to none, none is known so well
TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class Whitening:
    """What whitens weighted rows, in pieces of trials.

    Attributes:
        pieces: which rows, and the matrix that whitens them, shape (r, r).
    """

    pieces: tuple[tuple[slice, FloatArray], ...]

    def scaled(self, factors: FloatArray) -> "Whitening":
        """The same, each row (n,) times a factor."""
        return Whitening(tuple((rows, factors[rows, None] * root) for rows, root in self.pieces))

    @classmethod
    def of(cls, noise: Noise) -> "Whitening":
        """Of a noise."""
        return cls(tuple((rows, _root_of_precision(own)) for rows, own in _covariances(noise)))

    def whitened(self, values: FloatArray) -> FloatArray:
        """Weighted rows (n, k), as they were measured, of unit noise."""
        found = np.empty_like(values)
        for rows, root in self.pieces:
            found[rows] = root @ values[rows]
        return found


def _covariances(noise: Noise) -> Iterator[tuple[slice, FloatArray]]:
    """Of each piece's rows, (r, r)."""
    longest = max((int(place.grid[-1]) + 1 for place in noise.places), default=1)
    gains = np.sqrt([spectral_density(own, 2 * longest) for own in noise.autocovariances])
    between = np.array([[np.fft.irfft(one * other, 2 * longest)[:longest] for other in gains] for one in gains])
    strokes = noise.strokes
    for place in noise.places:
        for start in range(0, len(place.grid), MOST_ROWS):
            grid, speed = (one[start : start + MOST_ROWS] for one in (place.grid, place.speed))
            rows = slice(place.rows.start + start, place.rows.start + start + len(grid))
            size = np.sqrt(place.power[speed])
            apart = np.abs(np.subtract.outer(grid, grid))
            covariance = between[speed[:, None], speed, apart] * np.outer(size, size)
            if strokes is not None:
                share, index = strokes.share[rows], strokes.index[rows]
                covariance += noise.from_stop_to_stop * np.outer(share, share) * np.equal.outer(index, index)
            yield rows, covariance


def _root_of_precision(covariance: FloatArray) -> FloatArray:
    """The symmetric root, so that what is whitened stays about where it was in time."""
    powers, axes = np.linalg.eigh(covariance)
    known = np.maximum(np.maximum(powers, LEAST_POWER * float(powers.mean())), TINY)
    root: FloatArray = (axes / np.sqrt(known)) @ axes.T
    return root
