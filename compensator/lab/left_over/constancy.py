"""Whether what a model takes for constant is another one in each stretch: friction that jumps, a zero that shifts.

A coefficient of every stretch of its own, beside the model's one for all (parameter constancy: Chow 1960, Nyblom 1989).
What is missing and follows a driver comes back with it, and so in every trial alike; what jumps does not. Static
friction is another one from stop to stop, by some percent (the paper's repeated steps), and slow strokes keep what they
began with: each of these is allowed its own, or every joint would seem to change.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.left_over.constants import DRY_FRICTION, OFFSET, Constants
from compensator.lab.left_over.drift import Moments, chance_of_drift, moments_of
from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.model.held_out_error import rms
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.rows.dataset import BLOCK_S
from compensator.lab.screening.base import Base
from compensator.lab.screening.evidence import inflation_of

FEWEST_ROWS = 8  # of a stretch
CHANCE = PLAIN.change  # of so much change in noise alone
LEAST_SHARE = 0.004  # of dry friction: what scatters by 2 % over 0.05 rad leaves so much of a mean over some 2 rad
LEAST_OF_EFFORT = 0.005  # as little, of all that the motor gives, is nothing to repeat a trial for
MOST_STATIC = 0.05  # share of dry friction, in a stroke: it scatters by some percent, of which this is next to nothing
NEGLIGIBLE = 1e-6  # share of a column's power that the stretches leave: the base's own constants are sums of theirs


@dataclass(frozen=True, slots=True)
class Change:
    """Something constant that is another one in each stretch.

    Attributes:
        what: DRY_FRICTION or OFFSET.
        chance: of so much change in noise alone.
        share: root mean square of what changes, less what noise makes of it, over the effort's.
        least: of it, for it to be worth saying.
    """

    what: str
    chance: float
    share: float
    least: float = LEAST_OF_EFFORT

    @property
    def is_there(self) -> bool:
        """Whether it is neither noise nor next to nothing."""
        return self.chance <= CHANCE and self.share > self.least


def change_of(constants: Constants) -> Change | None:
    """What changes most from one stretch of 2 s to the next; None where nothing does for sure."""
    dataset, rows, weights = constants.dataset, constants.rows, constants.weights
    base, friction = constants.base, constants.friction
    sliding = constants.sliding
    labels, stretch = np.unique(dataset.block_index[rows], return_inverse=True)
    count = np.bincount(stretch, sliding)
    chosen = np.where(sliding & (count[stretch] >= FEWEST_ROWS), weights, 0.0)
    columns: Mapping[str, FloatArray] = {DRY_FRICTION: chosen * constants.direction, OFFSET: chosen}
    power = float(np.sum((weights * constants.effort) ** 2))
    moments = moments_of(dataset, rows)
    slow = _by_stroke(constants)
    beside = Base.of(slow.taken_out(base.basis), slow.taken_out(base.residual[:, None])[:, 0])
    found = [
        _change(what, beside, slow.taken_out(column[:, None])[:, 0], stretch, len(labels), power, moments)
        for what, column in columns.items()
    ]
    of_friction = LEAST_SHARE * friction / max(rms(constants.effort), np.finfo(float).tiny)
    least = max(of_friction, LEAST_OF_EFFORT)
    judged = [replace(change, least=least) for change in found if change is not None]
    there = [change for change in judged if change.is_there]
    return max(there, key=lambda change: change.share, default=None)


@dataclass(frozen=True)
class _ByStroke:
    """A column of each stroke of its own: its values (n,), the stroke of each row (n,), its power in each stroke."""

    column: FloatArray
    stroke: IntArray
    power: FloatArray

    def taken_out(self, values: FloatArray) -> FloatArray:
        """What a fit of the column in every stroke leaves of values (n, k)."""
        shares = [np.bincount(self.stroke, self.column * one, len(self.power)) / self.power for one in values.T]
        left: FloatArray = values - self.column[:, None] * np.array(shares).T[self.stroke]
        return left


def _by_stroke(constants: Constants) -> _ByStroke:
    """Static friction of each stroke of its own: it is another one from stop to stop, which is no change."""
    dataset, rows = constants.dataset, constants.rows
    static, least = constants.weights * constants.static, MOST_STATIC * constants.friction * constants.weights
    direction = dataset.rows_of([trial.motion.direction for trial in dataset.trials])
    turns = np.diff(np.sign(direction), prepend=0.0) != 0.0
    starts = np.diff(dataset.trial_index, prepend=-1) != 0
    _, stroke = np.unique(np.cumsum(turns | starts)[rows], return_inverse=True)
    shows = np.bincount(stroke, static**2) > np.bincount(stroke, least**2)
    column = np.where(shows[stroke], static, 0.0)
    power = np.bincount(stroke, column**2)
    return _ByStroke(column, stroke, np.where(power > 0.0, power, 1.0))


def _change(
    what: str,
    base: Base,
    column: FloatArray,
    stretch: "np.ndarray[tuple[int], np.dtype[np.intp]]",
    of: int,
    power: float,
    moments: Moments,
) -> Change | None:
    """How much the column's coefficient drifts, by cutting it into stretches, and the chance of that if it does not."""
    own = np.bincount(stretch, column**2, of)
    kept = own > 0.0
    inverse = np.where(kept, 1.0 / np.where(kept, own, 1.0), 0.0)
    shared = np.array([np.bincount(stretch, column * one, of) for one in base.basis.T]).reshape(-1, of)
    moment = np.bincount(stretch, column * base.residual, of)
    # what the stretches leave of the base's columns, so that the base may be fitted anew beside them
    left, axes = np.linalg.eigh(np.eye(len(shared)) - (shared * inverse) @ shared.T)
    solid = left > NEGLIGIBLE
    again = -axes[:, solid] @ (axes[:, solid].T @ ((shared * inverse) @ moment) / left[solid])
    within = inverse * (moment - shared.T @ again)
    after = base.residual - base.basis @ again - column * within[stretch]
    rank = int(kept.sum()) - int((~solid).sum())
    freedom = len(after) - rank - len(shared)
    rest = float(after @ after)
    if rank < 1 or freedom < 1 or rest == 0.0 or power == 0.0:
        return None
    noise = inflation_of(after) * rest / freedom
    explained = float(base.residual @ base.residual) - rest
    chance = chance_of_drift(moments, base, column, noise)
    return Change(what, chance, float(np.sqrt(max(explained - rank * noise, 0.0) / power)))


def changing_in_words(change: Change) -> str:
    """What is not as constant as the model takes it for."""
    return f"{change.what} changes from one stretch of {BLOCK_S:g} s to the next, by {change.share:.1%} of the effort"
