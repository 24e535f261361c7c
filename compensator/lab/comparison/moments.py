"""Moments of a study's trials: when the joint was somewhere, and when an effect takes most of the error away."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import rms
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.rows.drivers import available

PAUSE_S = 0.25  # rows further apart are two moments
STRETCH_S = 0.5  # how long a moment is that an effect is looked for in
MOST_MOMENTS = 12


@dataclass(frozen=True, slots=True)
class Moment:
    """A stretch of one trial during which every criterion held, but for pauses.

    Attributes:
        trial: index in the dataset.
        from_s, to_s: since the start of the trial.
        rows: that met the criteria; rms, mean: of their residual, in the effort's unit.
    """

    trial: int
    from_s: float
    to_s: float
    rows: int
    rms: float
    mean: float


@dataclass(frozen=True, slots=True)
class Gained:
    """A stretch of one trial in which a second model is closer than a first one.

    Attributes:
        moment: with the residual of the first model.
        rms_after: of the second model's residual, in the effort's unit.
        share: of all that the second model takes away of the squared residual, 0..1.
    """

    moment: Moment
    rms_after: float
    share: float


def moments(fit: Fit, criteria: Mapping[str, tuple[float, float]]) -> list[Moment]:
    """Moments at which drivers lay between two values, the one with most error first; at most MOST_MOMENTS.

    Args:
        fit: the model.
        criteria: driver -> lowest and highest value.

    Raises:
        NotApplicableError: a driver that these trials do not have, or that does not vary.
    """
    values = available(fit.dataset)
    rows = fit.dataset.counted.copy()
    for name, (low, high) in criteria.items():
        if name not in values:
            raise NotApplicableError(f"these trials have no driver '{name}' that varies; they have {', '.join(values)}")
        rows &= (values[name] >= low) & (values[name] <= high)
    found = _stretches(fit, rows)
    return sorted(found, key=lambda one: one.rms**2 * one.rows, reverse=True)[:MOST_MOMENTS]


def gained(before: Fit, after: Fit) -> list[Gained]:
    """Stretches of STRETCH_S in which `after` is closest beside `before`, the largest gain first; at most MOST_MOMENTS.

    The gain is the fall of the squared residual, to which each row adds its part of the evidence.

    Args:
        before: a model.
        after: another one of the same dataset, with an effect more.
    """
    dataset = before.dataset
    rows = np.flatnonzero(dataset.in_regimes(dataset.choice_for([term.effect for term in after.terms])))
    fall = before.residual[rows] ** 2 - after.residual[rows] ** 2
    times, found = _times(dataset), []
    for part in np.split(np.arange(len(rows)), _starts(dataset, times, rows, STRETCH_S)):
        gain = float(fall[part].sum()) if len(part) else 0.0
        if gain > 0.0:
            found.append((gain, rows[part]))
    total = sum(gain for gain, _ in found)
    best = sorted(found, key=lambda one: one[0], reverse=True)[:MOST_MOMENTS]
    return [Gained(_moment(before, times, part), rms(after.residual[part]), gain / total) for gain, part in best]


def _stretches(fit: Fit, rows: BoolArray) -> list[Moment]:
    chosen = np.flatnonzero(rows)
    times = _times(fit.dataset)
    return [_moment(fit, times, part) for part in np.split(chosen, _starts(fit.dataset, times, chosen)) if len(part)]


def _moment(fit: Fit, times: FloatArray, rows: IntArray) -> Moment:
    """One stretch, given its rows."""
    time, residual = times[rows], fit.residual[rows]
    trial = int(fit.dataset.trial_index[rows[0]])
    return Moment(trial, float(time[0]), float(time[-1]), len(rows), rms(residual), float(residual.mean()))


def _starts(dataset: Dataset, times: FloatArray, rows: IntArray, longest_s: float = np.inf) -> IntArray:
    """Where among these rows another stretch begins: in another trial, after a pause, or once one is long enough."""
    trial, time = dataset.trial_index[rows], times[rows]
    starts = (np.diff(trial) != 0) | (np.diff(time) > PAUSE_S)
    if np.isfinite(longest_s):
        starts |= np.diff(time // longest_s) != 0
    return np.flatnonzero(starts) + 1


def _times(dataset: Dataset) -> FloatArray:
    """Of all rows, since the start of their trials [s]."""
    return np.concatenate([dataset.time_of(trial) for trial in dataset.trials])
