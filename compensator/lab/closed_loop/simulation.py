"""Where a fitted model's joint goes under the control law that a trial ran under.

The model is any sum of effects, some with memory, which can be computed along a whole motion only. So the motion is
found by relaxation: the model is taken around a motion (at first the measured one), linearised, moved, and taken anew
around where it went (waveform relaxation: Lelarasmee, Ruehli, Sangiovanni-Vincentelli 1982).
"""

from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.closed_loop.control_law import ControlLaw, law_of, target_of
from compensator.lab.closed_loop.resistance import resistances
from compensator.lab.closed_loop.stepping import Drive, moved
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.low_pass import low_pass
from compensator.lab.recordings.processing import DIFFERENTIATION_FACTOR
from compensator.lab.recordings.recording import BoolArray, FloatArray, Recording
from compensator.lab.rows.assembly import more_trials
from compensator.lab.rows.dataset import Dataset, Trial

MOST_PASSES = 20
FREE_PASSES = 4
SETTLED = 0.02  # change from pass to pass, over how far the model's joint is from the measured one


@dataclass(frozen=True)
class Simulated:
    """One trial of a model in closed loop; arrays of shape (n,) on the trial's grid.

    Attributes:
        law: that it ran under.
        closed: where the loop is closed; elsewhere the joint is where it was measured.
        position: of the model's joint.
        effort: that the law gives there: the measured one, and what it adds for the difference.
        settled: the passes came to an end.
    """

    law: ControlLaw
    closed: BoolArray
    position: FloatArray
    effort: FloatArray
    settled: bool


def simulate(fit: Fit, trial: Trial, told: ControlLaw | None = None) -> Simulated:
    """Move a model's joint through one trial.

    Args:
        fit: of the model; its coefficients count, whatever rows they were fitted to.
        trial: of the fit's dataset, or made with its scales.
        told: the law that the bench ran it under; None leaves it to the recording.

    Raises:
        UnusableDataError: the model tells no inertia, so that nothing tells how it moves.
    """
    drive, law = _drive(fit, trial, told)
    motion, last, settled = _only(fit.dataset, trial), trial.signals.position, False
    for turn in range(MOST_PASSES):
        (resistance,) = resistances(fit, motion)
        position, added = moved(drive, resistance)
        change, off = _rms(position - last, drive.closed), _rms(position - drive.position, drive.closed)
        settled = change <= SETTLED * off
        if settled:
            break
        # what sticks in one pass and slides in the next is halved until it does neither
        last = position if turn < FREE_PASSES else 0.5 * (last + position)
        motion = dataset_of_motion(fit.dataset, trial, last)
    return Simulated(law, drive.closed, position, drive.effort + added, settled)


def dataset_of_motion(dataset: Dataset, trial: Trial, position: FloatArray) -> Dataset:
    """The one trial with another motion: its rows as if it had been recorded so."""
    return more_trials(dataset, [moved_recording(dataset, trial, position)])


def moved_recording(dataset: Dataset, trial: Trial, position: FloatArray) -> Recording:
    """A trial's recording with its joint elsewhere; what the drive says of speed is left out."""
    recording, unit = trial.signals.recording, dataset.facts.position_unit
    raw_s = recording.channels["time_s"]
    channels = {name: values for name, values in recording.channels.items() if not name.startswith("velocity_")}
    channels[f"position_{unit}"] = np.interp(raw_s, trial.signals.time_s, position)
    return replace(recording, channels=channels)


def _only(dataset: Dataset, trial: Trial) -> Dataset:
    scales = dataset.scales_for_others
    return replace(dataset, trials=(trial,), scales=scales, uncorrected=None, cache={}, unfiltered={})


def _drive(fit: Fit, trial: Trial, told_law: ControlLaw | None) -> tuple[Drive, ControlLaw]:
    signals, dataset = trial.signals, fit.dataset
    inertia = next((term for term in fit.terms if term.effect.name == "inertia"), None)
    told = 0.0 if inertia is None else float(inertia.coefficients @ (1.0, trial.motion.load_inertia_kg_m2))
    if told <= 0.0:
        raise UnusableDataError(
            "the model has no inertia, so that nothing tells how it would move; let it have the effect inertia, and "
            "record motion that accelerates: sines of several frequencies, steps"
        )
    target = target_of(signals, dataset.facts)
    law = law_of(signals, target, dataset.cutoff_hz, told, told_law)
    wide_hz = DIFFERENTIATION_FACTOR * dataset.cutoff_hz
    drive = Drive(
        step_s=1.0 / signals.rate_hz,
        closed=signals.usable,
        target=signals.position if target is None else target,
        position=signals.position,
        velocity=signals.velocity,
        effort=low_pass(signals.effort, wide_hz, signals.rate_hz),
        stiffness=law.stiffness,
        integral=law.integral,
        damping=law.damping,
        dead_band=law.dead_band,
    )
    return drive, law


def _rms(values: FloatArray, inside: BoolArray) -> float:
    return float(np.sqrt(np.mean(values[inside] ** 2))) if inside.any() else 0.0
