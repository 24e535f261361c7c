"""How much of what a model leaves comes again where a trial was repeated: that is the joint's, the rest has changed."""

from itertools import combinations

import numpy as np

from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.recordings.repeats import ALIKE, likeness, repeats
from compensator.lab.rows.dataset import Dataset

ALL = 0.995  # of what is left: told as all of it


def share_that_recurs(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> float | None:
    """Intraclass correlation of a residual over repeated trials, at equal times (Fisher 1925).

    Args:
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        rows: chosen, shape (N,).

    Returns:
        0 where it is another one each time, 1 where it is the same; None where no trial was repeated.
    """
    recordings = [trial.signals.recording for trial in dataset.trials]
    left = np.zeros(len(rows))
    left[rows] = residual
    own = [
        (dataset.time_of(trial)[rows[there]], left[there][rows[there]])
        for trial, there in zip(dataset.trials, dataset.trial_rows, strict=True)
    ]
    shared, both = 0.0, 0.0
    for members in repeats(recordings):
        for one, other in combinations(members, 2):
            if (likeness(recordings[one], recordings[other]) or 0.0) >= ALIKE:
                first, second = _at_equal_times(own[one], own[other])
                shared += 2.0 * float(first @ second)
                both += float(first @ first + second @ second)
    return min(max(shared / both, 0.0), 1.0) if both > 0.0 else None


def _at_equal_times(
    one: tuple[FloatArray, FloatArray], other: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Values (n,) of two trials, each given by its times and values, where both have a row."""
    (time_s, values), (other_s, others) = one, other
    if len(time_s) < 2 or len(other_s) < 2:
        return np.empty(0), np.empty(0)
    step_s = float(np.median(np.diff(time_s)))
    place = np.clip(np.searchsorted(other_s, time_s - 0.5 * step_s), 0, len(other_s) - 1)
    near = np.abs(other_s[place] - time_s) <= 0.5 * step_s
    return values[near], others[place[near]]


def recurring_share_in_words(share: float | None) -> str:
    """What repeats say of what is left, or that one is wanted, as a sentence."""
    if share is None:
        return "Repeat a trial: what comes again is the joint's, what does not has changed since."
    if share > ALL:
        return "In repeated trials all of it comes again: it is the joint's."
    return f"In repeated trials {share:.0%} of it comes again, which is the joint's; the rest has changed since."
