"""A model held against the measurement in closed loop: error of motion and of effort, by trial and in all."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.closed_loop.control_law import ControlLaw, LawSource
from compensator.lab.closed_loop.simulation import Simulated, simulate
from compensator.lab.model.fitted import Fit, trained_trials, with_terms
from compensator.lab.model.held_out_error import rms
from compensator.lab.model.intervals import without_each
from compensator.lab.model.validation import FEWEST_TRIALS
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.low_pass import low_pass
from compensator.lab.recordings.processing import DIFFERENTIATION_FACTOR
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset, Trial

Laws = Sequence[ControlLaw | None]
"""What the bench says of the servo of each trial of a dataset; None where it says nothing."""


@dataclass(frozen=True)
class LoopError:
    """Errors over the samples at which the loop is closed.

    Attributes:
        samples: how many.
        position: root mean square, in the joint's unit.
        position_relative: over the standard deviation of the measured position.
        velocity_relative: over the root mean square of the measured speed.
        effort: root mean square below the final cut-off, in the effort's unit.
        effort_relative: over that of the measured effort.
    """

    samples: int
    position: float
    position_relative: float
    velocity_relative: float
    effort: float
    effort_relative: float


@dataclass(frozen=True)
class TrialInLoop:
    """One trial of a model in closed loop.

    Attributes:
        name: of the recording.
        held_out: the coefficients have not seen it.
        source: who tells the control law.
        settled: the simulation came to an end.
        error: of this trial.
        simulated: where the joint went.
    """

    name: str
    held_out: bool
    source: LawSource
    settled: bool
    error: LoopError
    simulated: Simulated


@dataclass(frozen=True)
class LoopComparison:
    """A model in closed loop.

    Attributes:
        trials: in the dataset's order, with the coefficients that the model has.
        training: over the trials it was fitted to.
        held_out: over trials that its coefficients have not seen: those held out, or each left out in turn; None where
            there are too few.
        left_out: effects of the measuring chain, which move nothing.
    """

    trials: tuple[TrialInLoop, ...]
    training: LoopError
    held_out: LoopError | None
    left_out: tuple[str, ...]


def compare_in_loop(fit: Fit, laws: Laws | None = None) -> LoopComparison:
    """Move a model's joint through every trial of its dataset.

    Args:
        fit: of the model.
        laws: what the bench says of its servo; other trials' laws come from the recordings.

    Raises:
        UnusableDataError: as `simulate`.
    """
    return compare_coefficients(fit, fit, laws)


def compare_coefficients(fit: Fit, coefficients: Fit, laws: Laws | None = None) -> LoopComparison:
    """As `compare_in_loop`, with the coefficients of another fit of the same model."""
    dataset = fit.dataset
    told = laws or [None] * len(dataset.trials)
    trained = trained_trials(dataset, fit.training)
    seen = [index in trained for index in range(len(dataset.trials))]
    model = with_terms(fit, coefficients.coefficients)
    runs = [simulate(model, trial, law) for trial, law in zip(dataset.trials, told, strict=True)]
    trials = tuple(
        TrialInLoop(
            trial.signals.recording.name, not known, run.law.source, run.settled, _error([(trial, run)], dataset), run
        )
        for trial, run, known in zip(dataset.trials, runs, seen, strict=True)
    )
    pairs = list(zip(dataset.trials, runs, strict=True))
    outside = [pair for pair, known in zip(pairs, seen, strict=True) if not known]
    return LoopComparison(
        trials=trials,
        training=_error([pair for pair, known in zip(pairs, seen, strict=True) if known], dataset),
        held_out=_error(outside, dataset) if outside else _in_turn(fit, coefficients, told, pairs),
        left_out=tuple(term.effect.name for term in fit.terms if term.effect.pipeline),
    )


def _in_turn(fit: Fit, coefficients: Fit, told: Laws, runs: Sequence[tuple[Trial, Simulated]]) -> LoopError | None:
    """Each trial with the coefficients that all others give; None where there are too few of them.

    A trial of which no row was fitted is unknown to the coefficients as it is.
    """
    labels = np.unique(coefficients.dataset.trial_index[coefficients.training])
    if len(labels) < FEWEST_TRIALS:
        return None
    pairs = list(runs)
    for label, values in zip(labels.tolist(), without_each(coefficients), strict=True):
        trial = fit.dataset.trials[label]
        pairs[label] = trial, simulate(with_terms(fit, values), trial, told[label])
    return _error(pairs, fit.dataset)


def _error(pairs: Sequence[tuple[Trial, Simulated]], dataset: Dataset) -> LoopError:
    """Errors over all of the trials."""
    parts = [_differences(trial, run, dataset.cutoff_hz) for trial, run in pairs]
    position, speed, effort, centred, moving, measured = (np.concatenate(one) for one in zip(*parts, strict=True))
    return LoopError(
        samples=len(position),
        position=rms(position),
        position_relative=_share(position, centred),
        velocity_relative=_share(speed, moving),
        effort=rms(effort),
        effort_relative=_share(effort, measured),
    )


def _differences(trial: Trial, run: Simulated, cutoff_hz: float) -> tuple[FloatArray, ...]:
    """Differences of position, speed and effort, and what each is measured by, at the samples that count."""
    signals, inside, rate_hz = trial.signals, run.closed, trial.signals.rate_hz
    smooth = low_pass(run.position, DIFFERENTIATION_FACTOR * cutoff_hz, rate_hz)
    speed = rate_of_change(smooth, rate_hz)
    measured, effort = low_pass(np.array([signals.effort, run.effort]), cutoff_hz, rate_hz)
    position = signals.position[inside]
    return (
        run.position[inside] - position,
        speed[inside] - signals.velocity[inside],
        effort[inside] - measured[inside],
        position - (position.mean() if len(position) else 0.0),
        signals.velocity[inside],
        measured[inside],
    )


def _share(difference: FloatArray, whole: FloatArray) -> float:
    power = float(whole @ whole)
    return float(np.sqrt(difference @ difference / power)) if power > 0.0 else float("nan")
