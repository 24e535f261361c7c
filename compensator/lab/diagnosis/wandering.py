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
from scipy.stats import chi2

from compensator.lab.diagnosis.constants import DRY_FRICTION, OFFSET, Constants
from compensator.lab.diagnosis.variance_components import Likelihood, Part, likeliest
from compensator.lab.model.validation import rms
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import IntArray

CHANCE = 0.0025  # of so much wandering in noise alone
LEAST_OF_FRICTION = 0.002  # root mean square: less is the joint's own
LEAST_OF_EFFORT = 0.001  # the same of a constant force
LASTS_S = 3.0  # what it has become
NOISE_LASTS_S = (0.1, 0.5)  # beside what is white
PATHS = (0.02, 0.12)  # share of the travel, over which friction along the path is alike
CELL_S = 0.1  # rows that are taken together
MOST_CELLS = 120  # of a trial: longer ones have longer cells
MOST_TRIALS = 60  # spread over all
FEWEST_ROWS = 4  # of a stroke: fewer are all near its reversals
FEWEST_CELLS = 40
NAMED = 2  # trials


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

    @property
    def is_there(self) -> bool:
        """Whether it is neither noise nor next to nothing."""
        least = LEAST_OF_FRICTION if self.what == DRY_FRICTION else LEAST_OF_EFFORT
        return self.chance <= CHANCE and self.share > least


@dataclass(frozen=True)
class _Trial:
    """Cells of a trial, each the mean of its rows, of unit noise.

    Attributes:
        index: of the trial; time_s: of each cell, shape (c,).
        size: what wanders has of each, shape (c,).
        part: of the residuals, its components those of the null and, last, what wanders.
    """

    index: int
    time_s: FloatArray
    size: FloatArray
    part: Part


def wandering_of(constants: Constants) -> Wandering | None:
    """What wanders most surely; None where nothing does for sure, or where there are too few rows to tell."""
    direction = constants.direction
    whole = {DRY_FRICTION: (constants.friction, direction), OFFSET: (rms(constants.effort), np.ones(len(direction)))}
    found = [
        _wandering(what, size, _cells(constants, constants.weights * size * sign))
        for what, (size, sign) in whole.items()
        if size > 0.0
    ]
    there = [one for one in found if one is not None and one.is_there]
    return min(there, key=lambda one: one.chance, default=None)


def _wandering(what: str, size: float, trials: list[_Trial]) -> Wandering | None:
    """How much of something of a size wanders; None where there are too few rows to tell."""
    if sum(len(trial.time_s) for trial in trials) < FEWEST_CELLS:
        return None
    alone, without = likeliest([trial.part.without_last for trial in trials])
    beside, having = likeliest([trial.part for trial in trials], alone)
    gained = 2.0 * (having.value - without.value)
    chance = 0.5 * float(chi2.sf(gained, 1)) if gained > 0.0 else 1.0
    share = float(np.sqrt(beside[-1]))
    return Wandering(what, chance, share * size, share, _changes(trials, having))


def _cells(constants: Constants, column: FloatArray) -> list[_Trial]:
    """Sliding rows of every trial, taken together in cells within a stroke, as a weighted column (n,) has them."""
    dataset, base, static = constants.dataset, constants.base, constants.weights * constants.static
    sliding, numbers = constants.sliding, dataset.trial_index[constants.rows]
    strokes = np.concatenate([trial.motion.strokes.index[trial.picked] for trial in dataset.trials])[constants.rows]
    position = constants.of([trial.motion.position for trial in dataset.trials])
    times_s = np.concatenate([dataset.time_of(trial) for trial in dataset.trials])[constants.rows]
    lengths = [share * max(float(np.ptp(position)), np.finfo(float).tiny) for share in PATHS]
    there = np.unique(numbers[sliding])
    found = []
    for index in there[:: -(-len(there) // MOST_TRIALS)]:
        own = np.flatnonzero(sliding & (numbers == index) & (column != 0.0))
        _, of, count = np.unique(strokes[own], return_inverse=True, return_counts=True)
        own = own[count[of] >= FEWEST_ROWS]
        if len(own) < FEWEST_ROWS:
            continue
        width_s = max(CELL_S, float(np.ptp(times_s[own])) / MOST_CELLS)
        number = np.stack([strokes[own], np.floor(times_s[own] / width_s).astype(np.int64)])
        cells, cell = np.unique(number, axis=1, return_inverse=True)
        mean = _Mean(column[own], np.asarray(cell).reshape(-1))
        path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position[own])))])
        time_s, gone = mean.plain(times_s[own]), mean.plain(path)
        own_static = mean.of(static[own][:, None])[:, 0]
        turned = np.sign(mean.plain(column[own]))
        kernels = _kernels(mean.size, turned, time_s, gone, cells[0], own_static, lengths)
        part = Part(mean.of(base.basis[own]), mean.of(base.residual[own][:, None])[:, 0], kernels)
        found.append(_Trial(int(index), time_s, mean.size, part))
    return found


class _Mean:
    """Takes the rows of each cell together, by what wanders has of each.

    Args:
        column: of what wanders, weighted, shape (n,).
        cell: of each row, shape (n,).
    """

    def __init__(self, column: FloatArray, cell: IntArray) -> None:
        self._column, self._cell = column, cell
        self.size: FloatArray = np.sqrt(np.bincount(cell, column**2))

    def of(self, values: FloatArray) -> FloatArray:
        """Of weighted rows (n, k): the projection on the column, of unit noise."""
        return np.column_stack([np.bincount(self._cell, self._column * one) for one in values.T]) / self.size[:, None]

    def plain(self, values: FloatArray) -> FloatArray:
        """Of what is no effort, as a time."""
        found: FloatArray = np.bincount(self._cell, values) / np.bincount(self._cell)
        return found


def _kernels(
    size: FloatArray,
    turned: FloatArray,
    time_s: FloatArray,
    path: FloatArray,
    stroke: IntArray,
    static: FloatArray,
    lengths: list[float],
) -> FloatArray:
    """Covariances of the cells (c,) by each component of unit size, what wanders last; (k, c, c).

    Noise does not know which way friction points (`turned`), and changes its sign in these cells where that does.
    """
    apart_s = np.abs(np.subtract.outer(time_s, time_s))
    way = np.abs(np.subtract.outer(path, path))
    same = np.equal.outer(stroke, stroke)
    both = np.outer(size, size)
    return np.array(
        [
            np.eye(len(size)),
            *(np.outer(turned, turned) * np.exp(-apart_s / memory_s) for memory_s in NOISE_LASTS_S),
            *(both * same * np.exp(-way / length) for length in lengths),
            np.outer(static, static) * same,
            both * np.exp(-apart_s / LASTS_S),
        ]
    )


def _changes(trials: Sequence[_Trial], having: Likelihood) -> tuple[tuple[int, float], ...]:
    """Trials where its likeliest course (best linear prediction) changes most, and when it does [s]."""
    found = []
    for trial, weighed in zip(trials, having.weighed, strict=True):
        order = np.argsort(trial.time_s, kind="stable")
        time_s = trial.time_s[order]
        course = ((trial.part.kernels[-1] @ weighed) / trial.size)[order]
        if len(course) > 1:
            step = np.abs(np.diff(course))
            at = int(np.argmax(step))
            found.append((float(np.ptp(course)), trial.index, float(0.5 * (time_s[at] + time_s[at + 1]))))
    return tuple((index, at_s) for _, index, at_s in sorted(found, reverse=True)[:NAMED])
