"""Whether what a model takes for constant is another one in each stretch: friction that jumps, a zero that shifts.

A coefficient of every stretch of its own, beside the model's one for all (parameter constancy: Chow 1960, Nyblom 1989).
What is missing and follows a driver comes back with it, and so in every trial alike; what jumps does not.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.diagnosis.drift import Moments, chance_of_drift, moments_of
from compensator.lab.model.validation import rms
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.regimes import BoolArray, Regime
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.evidence import Base, inflation_of

FEWEST_ROWS = 8  # of a stretch
CHANCE = 1e-4  # of so much change in noise alone, whose colour is known by its first lag only
LEAST_SHARE = 0.005  # of dry friction: what scatters by 2 % over 0.05 rad leaves so much of the mean of a stretch
NEGLIGIBLE = 1e-6  # share of a column's power that the stretches leave: the base's own constants are sums of theirs

DRY_FRICTION, OFFSET = "dry friction", "a constant force or the zero of the angle"


@dataclass(frozen=True, slots=True)
class Change:
    """Something constant that is another one in each stretch.

    Attributes:
        what: DRY_FRICTION or OFFSET.
        chance: of so much change in noise alone.
        share: root mean square of what changes, less what noise makes of it, over the effort's.
        least: of it, for it to be more than dry friction scatters by without any cause.
    """

    what: str
    chance: float
    share: float
    least: float = LEAST_SHARE

    @property
    def is_there(self) -> bool:
        """Whether it is neither noise, nor less than friction differs without any cause."""
        return self.chance <= CHANCE and self.share > self.least


def change_of(dataset: Dataset, rows: BoolArray, base: Base, weights: FloatArray, friction: float) -> Change | None:
    """What changes most from one stretch of 2 s to the next; None where nothing does for sure.

    Args:
        dataset: of the rows.
        rows: chosen, shape (N,).
        base: what the model explains of them, and the weighted residual (n,).
        weights: of the chosen rows, shape (n,).
        friction: that the model takes for constant, in the effort's unit.
    """
    sliding = dataset.regime[rows] == Regime.SLIDING  # near reversals nothing is constant
    labels, stretch = np.unique(dataset.block_index[rows], return_inverse=True)
    count = np.bincount(stretch, sliding)
    chosen = np.where(sliding & (count[stretch] >= FEWEST_ROWS), weights, 0.0)
    direction = dataset.rows_of([trial.motion.direction for trial in dataset.trials])[rows]
    constants: Mapping[str, FloatArray] = {DRY_FRICTION: chosen * direction, OFFSET: chosen}
    power = float(np.sum((weights * dataset.effort[rows]) ** 2))
    moments = moments_of(dataset, rows)
    found = [_change(what, base, column, stretch, len(labels), power, moments) for what, column in constants.items()]
    least = LEAST_SHARE * friction / max(rms(dataset.effort[rows]), np.finfo(float).tiny)
    judged = [replace(change, least=least) for change in found if change is not None]
    there = [change for change in judged if change.is_there]
    return max(there, key=lambda change: change.share, default=None)


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
