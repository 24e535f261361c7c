"""Whether what a model leaves follows a variable that is measured, as a smooth curve, whatever the formula.

Flips of stretches know a curve's evidence no better than so few stretches can; rows whitened by the noise that a
complete model would leave know it by that noise. A curve that is told so need not be what is missing, so that it is
not offered for the model: it says that something is.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.white_rows import FORETOLD, WhiteRows
from compensator.lab.model.linear import orthonormal
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates

NEW = 0.05  # of a column's norm beside the model: of less, little can be told from the model itself


@dataclass(frozen=True, slots=True)
class Following:
    """A variable that what is left follows.

    Attributes:
        driver: as a free curve is called, "against motion" included.
        chance: of so much in noise alone, over all variables.
        foretold: evidence (2 ln L) in each stretch by the curve of all others, without the best stretch.
    """

    driver: str
    chance: float
    foretold: float


def following_of(gathered: Candidates, white: WhiteRows, most: float = PLAIN.following) -> Following | None:
    """The variable that is followed most surely; None where each may be noise, or of one stretch alone.

    Args:
        gathered: the model and its curves.
        white: its rows.
        most: chance in noise alone up to which it is none.
    """
    splines = gathered.curves.splines
    found = []
    for name, spline in splines.items():
        columns = _new(white, spline.columns[gathered.rows] * white.weights[:, None])
        size, rank = float(np.sum((white.residual @ columns) ** 2)), columns.shape[1]
        chance = min(1.0, len(splines) * white.noise.chance(size, rank)) if rank else 1.0
        if chance <= most:
            found.append(Following(name, chance, white.foretold(columns)[1]))
    there = [one for one in found if one.foretold >= FORETOLD]
    return max(there, key=lambda one: one.foretold, default=None)


def _new(white: WhiteRows, columns: FloatArray) -> FloatArray:
    """Orthonormal basis of what columns (n, k) add to the model, whitened."""
    before = np.linalg.norm(white.whitening.whitened(columns), axis=0)
    left = white.beside(columns)
    return orthonormal(left[:, np.linalg.norm(left, axis=0) > NEW * before])
