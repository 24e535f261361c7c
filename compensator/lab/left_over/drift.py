"""The chance that a coefficient which wanders in time, as it seems to, is constant: a test of its variance component.

Cut into stretches, a coefficient may be another one in each (Chow 1960); but what jumps at any moment, or creeps, is
alike in neighbouring moments. The locally best test of that (Nyblom 1989; Lin 1997) weighs moments by how alike they
would be, here by exp(-|t - t'| / MEMORY_S) within a trial:

Q = z' K z,  z_c = sum over the rows of moment c of column times residual

In noise of power s, z has the covariance s (diag(column'column) - what the base took of it), and Q is a sum of
chi-squared, which a gamma distribution of the same mean and variance stands for (Satterthwaite 1946). No matrix is
larger than one trial's moments.
"""

import numpy as np
from scipy.stats import gamma

from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.base import Base

MEMORY_S = 2.0  # as long as a stretch
MOMENT_S = 0.5  # what is shorter is noise
MOST_MOMENTS = 1000  # of a trial: longer ones have longer moments

Moments = tuple[IntArray, IntArray, FloatArray]
"""Moment of each row (n,), counted through; and of each moment its trial and its time [s]."""


def moments_of(dataset: Dataset, rows: BoolArray) -> Moments:
    """Cut the chosen rows of every trial into moments of MOMENT_S."""
    trial = dataset.trial_index[rows]
    times_s = [dataset.time_of(one) for one in dataset.trials]
    # a trial of which nothing is usable has no row, and no moment
    widths_s = np.array([max(MOMENT_S, float(time_s.max(initial=0.0)) / MOST_MOMENTS) for time_s in times_s])
    number = np.floor(np.concatenate(times_s)[rows] / widths_s[trial]).astype(np.int64)
    found, moment = np.unique(np.stack([trial, number], axis=1), axis=0, return_inverse=True)
    return moment.reshape(-1), found[:, 0], widths_s[found[:, 0]] * found[:, 1]


def chance_of_drift(moments: Moments, base: Base, column: FloatArray, noise: float) -> float:
    """The chance of so much drift in the coefficient of a column, beside a base, if it is constant.

    Args:
        moments: as `moments_of` says.
        base: beside which, and what it leaves of the rows.
        column: of the same rows, shape (n,).
        noise: power of what a row holds by chance, in the residual's unit squared.
    """
    moment, trial, time_s = moments
    of = len(trial)
    own = np.bincount(moment, column**2, of)
    score = np.bincount(moment, column * base.residual, of)
    shared = np.array([np.bincount(moment, column * one, of) for one in base.basis.T]).reshape(-1, of).T
    size, squares, spread = 0.0, 0.0, np.zeros_like(shared)
    for label in np.unique(trial):
        here = trial == label
        alike = np.exp(-np.abs(np.subtract.outer(time_s[here], time_s[here])) / MEMORY_S)
        size += float(score[here] @ alike @ score[here])
        squares += float(own[here] @ alike**2 @ own[here])
        spread[here] = alike @ shared[here]
    taken = shared.T @ spread
    mean = noise * (float(own.sum()) - float(np.trace(taken)))
    variance = (
        2.0 * noise**2 * (squares - 2.0 * float(own @ np.sum(spread**2, axis=1)) + float(np.sum(taken * taken.T)))
    )
    if mean <= 0.0 or variance <= 0.0:
        return 1.0
    return float(gamma.sf(size, mean**2 / variance, scale=variance / mean))
