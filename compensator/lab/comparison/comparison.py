"""Measured against predicted effort: errors by trial and regime, residual against every driver, repeatability floor."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from compensator.lab.at_rest.breakaway_comparison import BreakawayComparison, compare_breakaway
from compensator.lab.at_rest.rest_comparison import RestComparison, compare_at_rest
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import HeldOut, relative_error, rms
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.recordings.regimes import Regime
from compensator.lab.recordings.repeats import repeats
from compensator.lab.rows.dataset import Dataset
from compensator.lab.rows.drivers import available
from compensator.lab.rows.picture import BinnedMean, binned_mean

Direction = Literal["forward", "backward"]
FEWEST_REPEATED = 10  # rows at equal times, of which a scatter is told


@dataclass(frozen=True)
class ErrorOf:
    """Error over some rows.

    Attributes:
        name: of the trial or regime.
        rows: how many.
        rms: in the effort's unit.
        relative: ||residual|| / ||effort||.
    """

    name: str
    rows: int
    rms: float
    relative: float


@dataclass(frozen=True)
class ResidualAgainst:
    """Residual in bins of a driver, for one direction of motion ("forward", "backward")."""

    driver: str
    direction: Direction
    bins: BinnedMean


@dataclass(frozen=True)
class Comparison:
    """A model held against the measurement.

    Attributes:
        training: error over the rows it was fitted to.
        held_out: on rows it was not fitted to.
        floor: scatter between repeated trials, which the motion cannot explain; None without repeats.
        trials: error of each trial, in the dataset's order, over its counted rows.
        regimes: error of each regime over all rows. Of "stuck", what lies beyond the efforts between which friction
            holds, over stretches of 0.1 s; last, of breaking away, over the starts that were fitted.
        against: residual against every driver, by direction.
        breakaway: the model held against its starts from rest; None where there are too few.
        at_rest: the model held against the joint at rest; None where there is next to none.
    """

    fit: Fit
    training: ErrorOf
    held_out: HeldOut
    floor: ErrorOf | None
    trials: list[ErrorOf]
    regimes: list[ErrorOf]
    against: list[ResidualAgainst]
    breakaway: BreakawayComparison | None
    at_rest: RestComparison | None


def compare(fit: Fit) -> Comparison:
    """Hold a fitted model against all rows of its dataset."""
    dataset = fit.dataset
    trials = [
        _error(fit, trial.signals.recording.name, dataset.counted[own], own)
        for trial, own in zip(dataset.trials, dataset.trial_rows, strict=True)
    ]
    in_motion = (Regime.SLIDING, Regime.TRANSIENT)
    regimes = [_error(fit, regime.name.lower(), dataset.regime == regime) for regime in in_motion]
    at_rest = compare_at_rest(fit)
    if at_rest is not None:
        regimes.append(ErrorOf("stuck", at_rest.windows, at_rest.rms, at_rest.relative))
    breakaway = compare_breakaway(fit)
    if breakaway is not None:
        regimes.append(ErrorOf("breakaway", breakaway.training, breakaway.rms, breakaway.relative))
    return Comparison(
        fit=fit,
        training=_error(fit, "training", fit.training & dataset.counted),
        held_out=held_out(fit),
        floor=repeatability_floor(fit),
        trials=trials,
        regimes=[error for error in regimes if error.rows],
        against=_residual_against(fit),
        breakaway=breakaway,
        at_rest=at_rest,
    )


def repeatability_floor(fit: Fit) -> ErrorOf | None:
    """Scatter of the residual between trials that repeat each other: no model of the motion can explain it.

    Repeats share kind and every condition but `repeat` and their time, and run the same target: at equal times they
    scatter about their mean, by which each of n takes 1 / n of its own scatter away (pooled standard deviation).
    """
    recordings = [trial.signals.recording for trial in fit.dataset.trials]
    found = [_about_their_mean(fit, members) for members in repeats(recordings)]
    scatter = np.concatenate([np.empty(0), *(about_mean for about_mean, _ in found)])
    effort = np.concatenate([np.empty(0), *(own for _, own in found)])
    if len(scatter) < FEWEST_REPEATED:
        return None
    return ErrorOf("repeatability", len(scatter), rms(scatter), relative_error(scatter, effort))


def _error(fit: Fit, name: str, rows: BoolArray, within: slice = slice(None)) -> ErrorOf:
    """Over some of the rows within a part of all rows."""
    residual, effort = fit.residual[within][rows], fit.dataset.effort[within][rows]
    return ErrorOf(name, len(residual), rms(residual), relative_error(residual, effort))


def _about_their_mean(fit: Fit, members: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    """What trials leave beside their mean at equal times, unbiased, and their effort there.

    Rows at times at which no other trial has one do not count.
    """
    slots, rows = (np.concatenate(parts) for parts in zip(*(_slots(fit.dataset, one) for one in members), strict=True))
    _, place, count = np.unique(slots, return_inverse=True, return_counts=True)
    residual, together = fit.residual[rows], count[place]
    shared = together > 1
    about_mean = residual - (np.bincount(place, residual) / count)[place]
    unbiased = about_mean[shared] * np.sqrt(together[shared] / (together[shared] - 1.0))
    return unbiased, fit.dataset.effort[rows[shared]]


def _slots(dataset: Dataset, index: int) -> tuple[IntArray, IntArray]:
    """Times of one trial's counted rows, in steps that the filter lets apart, each once, and where these rows are."""
    own, step_s = dataset.trial_rows[index], 1.0 / (2.0 * dataset.cutoff_hz)
    counted = np.flatnonzero(dataset.counted[own])
    time_s = dataset.time_of(dataset.trials[index])[counted]
    slots, first = np.unique(np.round(time_s / step_s).astype(np.int64), return_index=True)
    return slots, own.start + counted[first]


def _residual_against(fit: Fit) -> list[ResidualAgainst]:
    dataset, rows = fit.dataset, fit.dataset.counted
    motion = dataset.rows_of([trial.motion.direction for trial in dataset.trials])
    found = []
    for name, values in available(dataset).items():
        if name in ("direction", "speed"):
            continue  # the sides are the directions, on either of which velocity is speed
        sides: dict[Direction, BoolArray] = {"forward": rows & (motion > 0), "backward": rows & (motion < 0)}
        for direction, side in sides.items():
            if side.any():
                bins = binned_mean(values[side], fit.residual[side], dataset.block_index[side])
                found.append(ResidualAgainst(name, direction, bins))
    return found
