"""Whether what a model leaves follows a variable that is measured, as a smooth curve, whatever the formula.

Flips of stretches know a curve's evidence no better than so few stretches can; rows whitened by the noise that a
complete model would leave know it by that noise. A curve that is told so need not be what is missing, so that it is
not offered for the model: it says that something is.

A joint that lacks nothing follows variables, too, by some thousandths of its dry friction, which is not quite the same
along its path, at each load and at each speed: what is so small must be beyond doubt.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.white_rows import FORETOLD, LOOK_AGAIN, WhiteRows
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates


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


def following_of(
    gathered: Candidates,
    white: WhiteRows,
    most: float = PLAIN.following,
    most_if_large: float = PLAIN.following_far,
    look_again: float = LOOK_AGAIN,
) -> Following | None:
    """The variable that is followed most surely; None where each may be noise, or of one stretch alone.

    Args:
        gathered: the model and its curves.
        white: its rows.
        most: chance in noise alone up to which it is none, however little it is.
        most_if_large: the same of what is more than the joint's own.
        look_again: the same in noise that is learnt with the curve, up to which noise without it is asked.
    """
    splines = gathered.curves.splines
    weighted = {name: one.columns[gathered.rows] * white.weights[:, None] for name, one in splines.items()}
    followed = {name: _followed(name, white, columns, len(splines)) for name, columns in weighted.items()}
    sure = [one for one in followed.values() if one.chance <= most and one.foretold >= FORETOLD]
    likely = [one for one in followed.values() if most < one.chance <= most_if_large and one.foretold >= FORETOLD]
    there = [*sure, *(one for one in likely if white.is_large(gathered, weighted[one.driver]))]
    if there or not followed:
        return max(there, key=lambda one: one.foretold, default=None)
    best = min(followed.values(), key=lambda one: one.chance)
    columns = weighted[best.driver]
    if not most_if_large < best.chance <= look_again or not white.is_large(gathered, columns):
        return None
    again = _followed(best.driver, white.cleared(gathered, columns), columns, len(splines))
    return again if again.chance <= most_if_large and again.foretold >= FORETOLD else None


def _followed(name: str, white: WhiteRows, weighted: FloatArray, tries: int) -> Following:
    """How surely a curve of weighted columns (n, k), one of so many, is followed."""
    columns = white.new(weighted)
    if columns.shape[1] == 0:
        return Following(name, 1.0, 0.0)
    chance = tries * white.noise.chance(float(np.sum((white.residual @ columns) ** 2)), columns.shape[1])
    return Following(name, min(1.0, chance), white.foretold(columns)[1])
