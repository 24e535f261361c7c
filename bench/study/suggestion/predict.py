"""What each possible trial would show, by the model fitted so far: every one is run on the model's own joint."""

from collections.abc import Sequence
from dataclasses import replace
from math import nan

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import Equipment, is_simulated
from bench.errors import BenchError
from bench.runs.in_memory import InMemoryBench
from bench.study.models.stages import CHOOSING, SIMULATING
from bench.study.suggestion.dynamics import dynamics_of
from bench.study.suggestion.options import Choice
from bench.study.suggestion.twin import Twin
from compensator.lab import progress
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.model.fitted import Fit
from compensator.lab.next_trial.suggest import suggest
from compensator.lab.next_trial.suggestion import Option, Suggestion
from compensator.lab.recordings.recording import SESSION_START, Condition, Recording
from compensator.lab.rows.dataset import Dataset
from drivers.errors import DriveError


def predicted(fit: Fit, configuration: BenchConfiguration, found: Sequence[Choice], once: bool = False) -> list[Option]:
    """The options whose trials the model's joint completes; `once` says that each tells nothing more the second time.

    Raises:
        StudyError: the model or the rig does not say how the joint moves.
    """
    progress.enter(SIMULATING)
    dynamics = dynamics_of(fit, configuration.rig)
    cold = is_simulated(configuration)  # a simulated joint is made anew for each experiment
    twin = Twin(dynamics, configuration.rig, _temperature_c(fit.dataset, cold))
    options = []
    with InMemoryBench(configuration, Equipment(twin, twin)) as bench:
        for choice in progress.each(found):
            try:
                recordings = [bench.record(plan, choice.kind) for plan in choice.plans]
            except (BenchError, DriveError):
                continue  # it stalls, trips or does not settle
            whole = tuple(_as_measured(one, fit.dataset, cold) for one in recordings)
            options.append(Option(choice.name, choice.duration_s / 60.0, whole, once))
    return options


def choose(
    fit: Fit,
    diagnosis: Diagnosis,
    configuration: BenchConfiguration,
    found: Sequence[Choice],
    most: int,
    once: bool = False,
) -> tuple[Suggestion, list[Choice]]:
    """What separates the rivals of a diagnosis most, and the experiments to start for it, in the same order.

    Args:
        fit: the diagnosed model.
        diagnosis: of it.
        configuration: of the bench.
        found: experiments that it could run.
        most: how many are chosen at most.
        once: each tells nothing more the second time: the bench repeats its very samples.

    Raises:
        StudyError, LabError: as `predicted` and `suggest`.
    """
    options = predicted(fit, configuration, found, once)
    progress.enter(CHOOSING)
    suggestion = suggest(fit, diagnosis, options, most)
    by_name = {choice.name: choice for choice in found}
    return suggestion, [by_name[pick.name] for pick in suggestion.picks]


def _as_measured(recording: Recording, dataset: Dataset, cold: bool) -> Recording:
    """The recording with the channels that the study's trials have, and as late in the session as it would be."""
    ones = np.ones(len(recording))
    filled = {name: ones for name in dataset.effort_definition.channels if name not in recording.channels}
    conditions: dict[str, Condition] = dict(recording.conditions)
    started = [trial.motion.conditions.get(SESSION_START) for trial in dataset.trials]
    if all(isinstance(one, int | float) for one in started):
        conditions[SESSION_START] = 0.0 if cold else max(float(t.motion.session_s[-1]) for t in dataset.trials)
    return replace(recording, channels={**recording.channels, **filled}, conditions=conditions)


def _temperature_c(dataset: Dataset, cold: bool) -> float:
    """At the start of the first trial, or at the end of the last one; NaN where it is not measured."""
    temperatures = [trial.motion.temperature_c for trial in dataset.trials]
    if not all(np.isfinite(one).all() for one in temperatures):
        return nan
    return float(temperatures[0][0] if cold else temperatures[-1][-1])
