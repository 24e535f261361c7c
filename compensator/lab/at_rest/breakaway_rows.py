"""Breakaway events of all trials as rows, with the columns of any effect at these moments."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.at_rest.breakaways import Start, resolution_of, starts_of
from compensator.lab.effects.effect import BreakawayShare, Effect, Motion, Onset, Shape
from compensator.lab.model.fitted import Fit, trained_trials
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset, Trial

RISE_S = 0.1  # that static friction takes to come up, at least: a quicker start shows the servo, not the contact
FEWEST_STARTS = 12  # fewer do not carry a regression
SCATTER = 0.25  # of static friction: an effort that scatters more is not known at the start
PAIR = 2  # starts of a trial in a row that make an independent unit


@dataclass(frozen=True)
class BreakawayRows:
    """Starts from rest whose effort is known. E rows, in the order of trials and time.

    Attributes:
        fit: the model; its position-dependent effects make the load at these moments.
        onsets: one per trial that has any.
        time_s, position: of each row, since the start of its trial; shape (E,).
        effort, effort_sd: at the start of motion, and how well it is known.
        held: part of it that the model's load takes at rest there: gravity and springs, as sliding tells them.
        direction, rest_s, rate, turns_back: as in `breakaways.Start`.
        trial_index: in the dataset.
        unit: independent unit: a trial, or two starts in a row of a trial that holds more.
        training: rows of training trials.
    """

    fit: Fit
    onsets: tuple[Onset, ...]
    time_s: FloatArray
    position: FloatArray
    effort: FloatArray
    effort_sd: FloatArray
    direction: FloatArray
    rest_s: FloatArray
    rate: FloatArray
    turns_back: BoolArray
    held: FloatArray
    trial_index: IntArray
    unit: IntArray
    training: BoolArray

    def __len__(self) -> int:
        return len(self.effort)

    @property
    def free(self) -> FloatArray:
        """Effort less what the load takes, shape (E,)."""
        return self.effort - self.held

    def columns(self, share: BreakawayShare, shape: Shape) -> FloatArray:
        """Columns of a share, shape (E, k)."""
        return np.concatenate([share.columns(onset, shape) for onset in self.onsets], axis=1).T

    def shapes(self, share: BreakawayShare) -> list[Shape]:
        """Shapes of a share to scan."""
        whole = replace(self.onsets[0], rest_s=self.rest_s, rate=self.rate)
        return share.shapes(whole)

    def driver(self, name: str) -> FloatArray | None:
        """Values of a driving variable, shape (E,); None where starts do not have it."""
        motions = [(onset.motion, len(onset.rate)) for onset in self.onsets]
        known: dict[str, FloatArray] = {
            "rest": self.rest_s,
            "start_rate": self.rate,
            "position": self.position,
            "direction": self.direction,
            "load": self.held,
            "load_kg": np.concatenate([np.full(count, motion.load_kg) for motion, count in motions]),
            "temperature": np.concatenate([motion.temperature_c for motion, _ in motions]),
        }
        return known.get(name)


def breakaway_rows(fit: Fit) -> BreakawayRows | None:
    """The starts of a fitted model's trials whose effort is known; None where there are none."""
    dataset = fit.dataset
    positions = [measured_position(trial, dataset) for trial in dataset.trials]
    count = resolution_of(positions)
    least = _static_friction(fit)
    onsets, starts, trials = [], [], []
    for index, (trial, position) in enumerate(zip(dataset.trials, positions, strict=True)):
        found = [
            start
            for start in starts_of(trial.signals, position, count, dataset.scales.slow)
            if 0.0 < start.rate <= least / RISE_S and start.effort_sd <= SCATTER * least
        ]
        if found:
            onsets.append(_onset(fit, trial, position, found))
            starts += [
                (start, float(trial.motion.time_s[start.index]), float(position[start.index])) for start in found
            ]
            trials += [index] * len(found)
    if not starts:
        return None
    trial_index = np.array(trials, dtype=np.int64)
    events = [start for start, _, _ in starts]
    return BreakawayRows(
        fit,
        tuple(onsets),
        time_s=np.array([time_s for _, time_s, _ in starts]),
        position=np.array([position for _, _, position in starts]),
        effort=np.array([start.effort for start in events]),
        effort_sd=np.array([start.effort_sd for start in events]),
        direction=np.array([start.direction for start in events]),
        rest_s=np.array([start.rest_s for start in events]),
        rate=np.array([start.rate for start in events]),
        turns_back=np.array([start.turns_back for start in events]),
        held=np.concatenate([onset.motion.load_effort for onset in onsets]),
        trial_index=trial_index,
        unit=_units(trial_index),
        training=np.isin(trial_index, trained_trials(dataset, fit.training)),
    )


def enough_starts(fit: Fit) -> BreakawayRows | None:
    """The starts of a fitted model's trials; None where those of training are too few for a regression."""
    rows = breakaway_rows(fit)
    return rows if starts_counted(rows) >= FEWEST_STARTS else None


def starts_counted(rows: BreakawayRows | None) -> int:
    """How many starts from rest whose effort is known a model is fitted to."""
    return 0 if rows is None else int(rows.training.sum())


def shares_of(effects: Sequence[Effect]) -> list[tuple[Effect, BreakawayShare]]:
    """Those effects that have a share in breakaway, but for loads, which sliding tells better (see `held`)."""
    return [(effect, effect.breakaway) for effect in effects if effect.breakaway is not None and not effect.carried]


def measured_position(trial: Trial, dataset: Dataset) -> FloatArray:
    """Position of a trial as measured, not filtered, on the signals' grid, shape (n,)."""
    channels = trial.signals.recording.channels
    measured = channels[f"position_{dataset.facts.position_unit}"]
    finite = np.isfinite(measured)
    return np.interp(trial.signals.time_s, channels["time_s"][finite], measured[finite])


def _static_friction(fit: Fit) -> float:
    """What sliding tells of it, in the effort's unit; the median effort where it tells nothing."""
    told = fit.dry_friction
    return told if told > 0.0 else float(np.median(np.abs(fit.dataset.effort)))


def _onset(fit: Fit, trial: Trial, position: FloatArray, starts: Sequence[Start]) -> Onset:
    index = np.array([start.index for start in starts], dtype=np.int64)
    direction = np.array([start.direction for start in starts])
    motion = at_rest_motion(fit, trial.motion, index, position[index], direction)
    return Onset(motion, np.array([s.rest_s for s in starts]), np.array([s.rate for s in starts]))


def at_rest_motion(fit: Fit, motion: Motion, index: IntArray, position: FloatArray, direction: FloatArray) -> Motion:
    """A trial's motion at some samples, as it is at rest there, about to go one way or the other.

    Args:
        fit: the model; what it carries at rest is the load.
        motion: of the trial.
        index: samples, shape (e,).
        position: there, shape (e,).
        direction: of the motion that would follow, shape (e,).
    """
    nothing = np.zeros(len(index))
    resting = replace(
        motion,
        time_s=motion.time_s[index],
        position=position,
        velocity=nothing,
        acceleration=nothing,
        jerk=nothing,
        misread_acceleration=nothing,
        direction=direction,
        load_effort=nothing,
        parting=nothing,
        predicted=nothing,
        effort_rate=nothing,
        temperature_c=motion.temperature_c[index],
        supply_v=motion.supply_v[index],
        measured_load=np.broadcast_to(motion.measured_load, motion.time_s.shape)[index],
        start_rate=np.nan,  # what it does to starts, each share says by its onset
    )
    load = nothing
    for term in fit.terms:
        if term.effect.carried:
            load = load + term.coefficients @ term.effect.columns(resting, term.shape)
    return replace(resting, load_effort=load)


def _units(trial_index: IntArray) -> IntArray:
    """Labels of what is independent of each other."""
    labels = np.zeros(len(trial_index), dtype=np.int64)
    following = 0
    for index in np.unique(trial_index):
        own = np.flatnonzero(trial_index == index)
        parts = np.minimum(np.arange(len(own)) // PAIR, max(len(own) // PAIR - 1, 0))
        labels[own] = following + parts
        following += int(parts.max()) + 1
    return labels
