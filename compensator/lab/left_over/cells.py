"""What wanders in time, and all that scatters beside it, on rows of a stroke that are taken together.

What scatters in every joint has a covariance of its own: noise forgets at once or within half a second, friction along
the path within some percent of the travel, static friction is another one after each stop, and all that is constant in
a trial is another one in the next. Near reversals, where teeth fly and pre-sliding comes up, rows scatter more, and in
each stroke in a way of its own: the more, the more reversals there are and the quicker, as in a chirp, so that each
trial has its own scale of that.
"""

from collections.abc import Sequence

import numpy as np

from compensator.lab.left_over.constants import Constants
from compensator.lab.left_over.variance_components import CellsOfTrial, Part
from compensator.lab.recordings.recording import FloatArray, IntArray

LASTS_S = 3.0  # what it has become
NOISE_LASTS_S = (0.1, 0.5)  # beside what is white
PATHS = (0.02, 0.12)  # share of the travel, over which friction along the path is alike
CELL_S = 0.1  # rows that are taken together
MOST_CELLS = 120  # of a trial: longer ones have longer cells
MOST_TRIALS = 60  # spread over all
FEWEST_ROWS = 4  # of a stroke: fewer are all near its reversals
NAMED = 2  # trials
TINY = float(np.finfo(float).tiny)


def cells_of(constants: Constants, column: FloatArray) -> list[CellsOfTrial]:
    """Rows of every trial, taken together in cells within a stroke, as a weighted column (n,) has them.

    Those near reversals have cells of their own.
    """
    dataset, base, static = constants.dataset, constants.base, constants.weights * constants.static
    near, numbers = ~constants.sliding, dataset.trial_index[constants.rows]
    strokes = np.concatenate([trial.motion.strokes.index[trial.picked] for trial in dataset.trials])[constants.rows]
    position = constants.of([trial.motion.position for trial in dataset.trials])
    times_s = np.concatenate([dataset.time_of(trial) for trial in dataset.trials])[constants.rows]
    lengths = [share * max(float(np.ptp(position)), TINY) for share in PATHS]
    there = np.unique(numbers)
    usual = _power(base.residual[near])
    found = []
    for index in there[:: -(-len(there) // MOST_TRIALS)]:
        own = np.flatnonzero((numbers == index) & (column != 0.0))
        _, of, count = np.unique(strokes[own], return_inverse=True, return_counts=True)
        own = own[count[of] >= FEWEST_ROWS]
        if len(own) < FEWEST_ROWS:
            continue
        width_s = max(CELL_S, float(np.ptp(times_s[own])) / MOST_CELLS)
        number = np.stack([strokes[own], np.floor(times_s[own] / width_s).astype(np.int64), near[own]])
        cells, cell = np.unique(number, axis=1, return_inverse=True)
        mean = _Mean(column[own], np.asarray(cell).reshape(-1))
        path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position[own])))])
        time_s, gone = mean.plain(times_s[own]), mean.plain(path)
        own_static = mean.of(static[own][:, None])[:, 0]
        turned = np.sign(mean.plain(column[own]))
        way = np.sign(mean.plain(constants.direction[own]))
        kernels = _kernels(mean.size, turned, way, time_s, gone, cells[0], own_static, lengths)
        if near.any():
            times = _power(base.residual[own[near[own]]]) / usual
            kernels = np.insert(kernels, 1, times * _near_reversals(mean.size, cells[0], cells[2]), axis=0)
        part = Part(mean.of(base.basis[own]), mean.of(base.residual[own][:, None])[:, 0], kernels)
        found.append(CellsOfTrial(int(index), time_s, mean.size, part))
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
    way: FloatArray,
    time_s: FloatArray,
    path: FloatArray,
    stroke: IntArray,
    static: FloatArray,
    lengths: list[float],
) -> FloatArray:
    """Covariances of the cells (c,) by each component of unit size, what wanders last; (k, c, c).

    Noise does not know which way friction points (`turned`), and changes its sign in these cells where that does.
    What is constant in a trial is another friction or another force, by the `way` of motion.
    """
    apart_s = np.abs(np.subtract.outer(time_s, time_s))
    between = np.abs(np.subtract.outer(path, path))
    same = np.equal.outer(stroke, stroke)
    both = np.outer(size, size)
    return np.array(
        [
            np.eye(len(size)),
            *(np.outer(turned, turned) * np.exp(-apart_s / memory_s) for memory_s in NOISE_LASTS_S),
            *(both * same * np.exp(-between / length) for length in lengths),
            np.outer(static, static) * same,
            both,
            both * np.outer(way, way),
            both * np.exp(-apart_s / LASTS_S),
        ]
    )


def _near_reversals(size: FloatArray, stroke: IntArray, near: IntArray) -> FloatArray:
    """Covariances that cells (c,) have beside those if they are near a reversal: 0 or 1; shape (2, c, c)."""
    own = near * size
    return np.array([np.diag(near.astype(float)), np.outer(own, own) * np.equal.outer(stroke, stroke)])


def _power(residual: FloatArray) -> float:
    """Mean square of residuals (n,), 1 of none."""
    return max(float(np.mean(residual**2)), TINY) if len(residual) else 1.0


def most_changed(trials: Sequence[CellsOfTrial], courses: Sequence[FloatArray]) -> tuple[tuple[int, float], ...]:
    """Trials where the course (c,) of what wanders changes most, most first, and when it does [s]."""
    found = []
    for trial, own in zip(trials, courses, strict=True):
        order = np.argsort(trial.time_s, kind="stable")
        time_s, course = trial.time_s[order], own[order]
        if len(course) > 1:
            step = np.abs(np.diff(course))
            at = int(np.argmax(step))
            found.append((float(np.ptp(course)), trial.index, float(0.5 * (time_s[at] + time_s[at + 1]))))
    return tuple((index, at_s) for _, index, at_s in sorted(found, reverse=True)[:NAMED])
