"""Whether dry friction, or a constant force, wanders in time, beside what scatters in every joint.

What jumps, or creeps, stays what it has become for seconds, whatever the motion. What scatters does not:
along the path it forgets within some percent of the travel, static friction is another one after each stop, and noise
forgets at once. Each has a variance component of its own, found by restricted likelihood (Patterson, Thompson 1971)
with the model fitted anew beside them, and is there only as far as the rows speak for it. So a change need not be
large to be told, only to last.

Twice the logarithm of the likelihood gained by one more component is, in noise alone, zero in half of all cases and
chi-squared of one degree of freedom in the others (Self, Liang 1987).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.left_over.cells import cells_of, most_changed
from compensator.lab.left_over.constants import DRY_FRICTION, OFFSET, Constants
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.variance_components import CellsOfTrial, Likeliest, likeliest, likelihood
from compensator.lab.model.held_out_error import rms
from compensator.lab.screening.evidence import chance_beyond

LEAST_OF_FRICTION = 0.002  # root mean square: less is the joint's own
LEAST_OF_EFFORT = 0.001  # the same of a constant force
FEWEST_CELLS = 40


@dataclass(frozen=True, slots=True)
class Wandering:
    """Something constant that wanders in time.

    Attributes:
        what: DRY_FRICTION or OFFSET.
        chance: of so much in noise alone.
        size: its root mean square, in the effort's unit.
        share: the same over dry friction, or, of an offset, over the effort.
        changes: trials where it changes most, most first, and when it does [s].
    """

    what: str
    chance: float
    size: float
    share: float
    changes: tuple[tuple[int, float], ...]

    def is_there(self, most: float) -> bool:
        """Whether it is neither noise, by the chance up to which it is none, nor next to nothing."""
        least = LEAST_OF_FRICTION if self.what == DRY_FRICTION else LEAST_OF_EFFORT
        return self.chance <= most and self.share > least


def wandering_of(constants: Constants, most: float = PLAIN.wandering) -> Wandering | None:
    """What wanders most surely; None where nothing does for sure, or where there are too few rows to tell.

    Args:
        constants: of the rows.
        most: chance in noise alone up to which it is none.
    """
    seen = constants.dataset.constant[constants.rows]
    whole = {DRY_FRICTION: (constants.friction, constants.direction * seen), OFFSET: (rms(constants.effort), seen)}
    found, scatter = [], None
    for what, (size, sign) in whole.items():
        trials = cells_of(constants, constants.weights * size * sign) if size > 0.0 else []
        if sum(len(trial.time_s) for trial in trials) < FEWEST_CELLS:
            continue
        # what scatters is nearly the same beside either
        alone = likeliest([trial.part.without_last for trial in trials], scatter)
        scatter = alone.shares
        found.append(_wandering(what, size, trials, alone))
    there = [one for one in found if one is not None and one.is_there(most)]
    return min(there, key=lambda one: one.chance, default=None)


def _wandering(what: str, size: float, trials: list[CellsOfTrial], alone: Likeliest) -> Wandering | None:
    """How much of something of a size wanders beside what scatters alone; None where nothing does."""
    parts = [trial.part for trial in trials]
    if likelihood(np.append(alone.variances, 0.0), parts).gradient[-1] <= 0.0:
        return None  # the likelihood falls with it from the first on: the score, which most joints stop at
    variances, _, having = likeliest(parts, alone.shares)
    share = float(np.sqrt(variances[-1]))
    # its likeliest course is the best linear prediction
    courses = [one.part.kernels[-1] @ own / one.size for one, own in zip(trials, having.weighed, strict=True)]
    chance = chance_of(2.0 * (having.value - alone.likelihood.value))
    return Wandering(what, chance, share * size, share, most_changed(trials, courses))


def chance_of(gained: float) -> float:
    """Of so much more likelihood, as twice its logarithm, by a component that is not there."""
    return 0.5 * float(chance_beyond(np.array([gained]), 1)[0]) if gained > 0.0 else 1.0


def wandering_in_words(wandering: Wandering, trials: Sequence[str], unit: str) -> str:
    """What is another one for seconds, by how much, and where to look for that."""
    moments = " and ".join(f"{trials[index]} at {at_s:.1f} s" for index, at_s in wandering.changes)
    of = "it" if wandering.what == DRY_FRICTION else "the effort"
    return (
        f"{wandering.what} is another one for seconds at a time, by {wandering.size:.2g} {unit}, {wandering.share:.1%} "
        f"of {of}; it changes most in {moments}"
    )
