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
from scipy.optimize import minimize
from scipy.stats import chi2

from compensator.lab.diagnosis.constancy import DRY_FRICTION, OFFSET
from compensator.lab.model.validation import rms
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.regimes import BoolArray, Regime
from compensator.lab.rows.dataset import Dataset, IntArray
from compensator.lab.screening.evidence import Base

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
SMALLEST, LARGEST = 1e-5, 50.0  # of a component, as a share of the residual's power
WHITE = 1e-3  # of it is white, at least
STEPS = 60
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
        base, residual: shape (c, b) and (c,).
        size: what wanders has of each, shape (c,).
        kernels: of all components of the null, and of what wanders last, shape (k, c, c).
    """

    index: int
    time_s: FloatArray
    base: FloatArray
    residual: FloatArray
    size: FloatArray
    kernels: FloatArray


@dataclass(frozen=True)
class _Likelihood:
    """Restricted log-likelihood, its gradient (k,), and what the precision makes of each trial's residual (c,)."""

    value: float
    gradient: FloatArray
    weighed: list[FloatArray]


def wandering_of(
    dataset: Dataset, rows: BoolArray, base: Base, weights: FloatArray, friction: float, static: FloatArray
) -> Wandering | None:
    """What wanders most surely; None where nothing does for sure, or where there are too few rows to tell.

    Args:
        dataset: of the rows.
        rows: chosen, shape (N,).
        base: what the model explains of them, and the weighted residual (n,).
        weights: of the chosen rows, shape (n,).
        friction: that the model takes for constant, in the effort's unit.
        static: how much of the effort is static friction that has not fallen off yet, shape (n,).
    """
    direction = dataset.rows_of([trial.motion.direction for trial in dataset.trials])[rows]
    whole = {DRY_FRICTION: (friction, direction), OFFSET: (rms(dataset.effort[rows]), np.ones(len(direction)))}
    found = [
        _wandering(what, size, _cells(dataset, rows, base, weights * size * sign, weights * static))
        for what, (size, sign) in whole.items()
        if size > 0.0
    ]
    there = [one for one in found if one is not None and one.is_there]
    return min(there, key=lambda one: one.chance, default=None)


def _wandering(what: str, size: float, trials: list[_Trial]) -> Wandering | None:
    """How much of something of a size wanders; None where there are too few rows to tell."""
    if sum(len(trial.residual) for trial in trials) < FEWEST_CELLS:
        return None
    alone, without = _likeliest([trial.kernels[:-1] for trial in trials], trials, None)
    beside, having = _likeliest([trial.kernels for trial in trials], trials, alone)
    gained = 2.0 * (having.value - without.value)
    chance = 0.5 * float(chi2.sf(gained, 1)) if gained > 0.0 else 1.0
    share = float(np.sqrt(beside[-1]))
    return Wandering(what, chance, share * size, share, _changes(trials, having))


def _cells(dataset: Dataset, rows: BoolArray, base: Base, column: FloatArray, static: FloatArray) -> list[_Trial]:
    """Sliding rows of every trial, taken together in cells within a stroke, as a weighted column (n,) has them."""
    sliding = dataset.regime[rows] == Regime.SLIDING
    numbers = dataset.trial_index[rows]
    strokes = np.concatenate([trial.motion.strokes.index[trial.picked] for trial in dataset.trials])[rows]
    position = dataset.rows_of([trial.motion.position for trial in dataset.trials])[rows]
    times_s = np.concatenate([dataset.time_of(trial) for trial in dataset.trials])[rows]
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
        basis, residual = mean.of(base.basis[own]), mean.of(base.residual[own][:, None])[:, 0]
        found.append(_Trial(int(index), time_s, basis, residual, mean.size, kernels))
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


def _likeliest(
    kernels: Sequence[FloatArray], trials: Sequence[_Trial], start: FloatArray | None
) -> tuple[FloatArray, _Likelihood]:
    """The likeliest variances (k,) of components, and their likelihood; from those of all but the last where known."""
    power = float(np.mean(np.concatenate([trial.residual for trial in trials]) ** 2)) or 1.0
    count = sum(len(trial.residual) for trial in trials)
    own = np.sum([np.trace(kernel, axis1=1, axis2=2) for kernel in kernels], axis=0) / count
    scale = power / np.where(own > 0.0, own, 1.0)
    begin = np.full(len(scale), 0.3 / len(scale))
    begin[0] = 0.5
    if start is not None:
        begin = np.append(np.maximum(start / scale[:-1], 10.0 * SMALLEST), 0.05)

    def unlikely(logarithms: FloatArray) -> tuple[float, FloatArray]:
        variances = scale * np.exp(logarithms)
        found = _likelihood(variances, kernels, trials)
        return -found.value, -variances * found.gradient

    bounds = [(np.log(WHITE), np.log(LARGEST)), *([(np.log(SMALLEST), np.log(LARGEST))] * (len(scale) - 1))]
    best = minimize(
        unlikely, np.log(begin), jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": STEPS, "ftol": 1e-7}
    )
    variances: FloatArray = scale * np.exp(best.x)
    return variances, _likelihood(variances, kernels, trials)


def _likelihood(variances: FloatArray, kernels: Sequence[FloatArray], trials: Sequence[_Trial]) -> _Likelihood:
    """Of the residuals, whatever the base's coefficients are."""
    precisions, volume = [], 0.0
    for own in kernels:
        root = np.linalg.cholesky(np.tensordot(variances, own, 1))
        inverse = np.linalg.inv(root)
        precisions.append(inverse.T @ inverse)
        volume += 2.0 * float(np.sum(np.log(np.diag(root))))
    sides = [precision @ trial.base for precision, trial in zip(precisions, trials, strict=True)]
    normal = np.sum([side.T @ trial.base for side, trial in zip(sides, trials, strict=True)], axis=0)
    moment = np.sum([side.T @ trial.residual for side, trial in zip(sides, trials, strict=True)], axis=0)
    powers, axes = np.linalg.eigh(normal)
    solid = powers > 1e-10 * powers[-1]  # cells may not tell all of the base's columns apart
    half = axes[:, solid] / np.sqrt(powers[solid])
    again = half @ (half.T @ moment)
    weighed, fits, gradient = [], 0.0, np.zeros(len(variances))
    for own, precision, side, trial in zip(kernels, precisions, sides, trials, strict=True):
        part = precision @ (trial.residual - trial.base @ again)
        shared = side @ half
        restricted = precision - shared @ shared.T
        gradient += 0.5 * ((own @ part) @ part - np.tensordot(own, restricted, 2))
        fits += float(trial.residual @ part)
        weighed.append(part)
    value = -0.5 * (volume + float(np.sum(np.log(powers[solid]))) + fits)
    return _Likelihood(value, gradient, weighed)


def _changes(trials: Sequence[_Trial], having: _Likelihood) -> tuple[tuple[int, float], ...]:
    """Trials where its likeliest course (best linear prediction) changes most, and when it does [s]."""
    found = []
    for trial, weighed in zip(trials, having.weighed, strict=True):
        order = np.argsort(trial.time_s, kind="stable")
        time_s = trial.time_s[order]
        course = ((trial.kernels[-1] @ weighed) / trial.size)[order]
        if len(course) > 1:
            step = np.abs(np.diff(course))
            at = int(np.argmax(step))
            found.append((float(np.ptp(course)), trial.index, float(0.5 * (time_s[at] + time_s[at + 1]))))
    return tuple((index, at_s) for _, index, at_s in sorted(found, reverse=True)[:NAMED])
