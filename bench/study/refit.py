"""A model's coefficients from all trials of experiments, however many rows they have: one piece of one at a time."""

from collections.abc import Iterator, Sequence

import numpy as np
from pydantic import Field

from bench.config.rig import Rig
from bench.json_types import Number
from bench.store import Store
from bench.store.records import Trial
from bench.study.errors import StudyError, lab_errors
from bench.study.material import facts_of, load_model
from bench.study.models.base import StudyModel
from compensator.lab.model.fitted import Fit
from compensator.lab.model.streaming import PIECE_ROWS, fit_streamed, later_by, piece_starts
from compensator.lab.recordings.recording import Recording


class RefittedParameter(StudyModel):
    """One linear parameter, on the study's trials and on all that were read."""

    effect: str
    name: str
    unit: str
    study: Number
    all: Number


class Refitted(StudyModel):
    """A model fitted anew to all trials of experiments; errors are relative (0..1)."""

    study_id: int
    model_id: int
    trials: int
    samples: int
    rows: int
    training: Number
    held_out: Number = Field(description="each trial left out in turn")
    parameters: list[RefittedParameter]
    skipped: list[str] = Field(description="trials that cannot be used, and why")


def refit(store: Store, study_id: int, experiment_ids: Sequence[int], model_id: int | None = None) -> Refitted:
    """Fit a model of a study anew to the completed trials of experiments; nothing is kept.

    The study's own trials give the cut-off, the shapes and the load that the model predicts. A study of a few trials
    can so be held against months of recordings.

    Raises:
        NotFoundError: no such study, model or experiment.
        StudyError: another rig, or no trial can be used.
    """
    material, model = load_model(store, study_id, model_id)
    fit = material.fit_of(model)
    for number in experiment_ids:
        if facts_of(Rig.model_validate(store.experiment(number).rig)) != material.definition.facts:
            raise StudyError(f"experiment {number} is of another rig than the study; make a study of its own for it")
    trials = [t for number in experiment_ids for t in store.trials(number) if t.outcome == "completed" and t.rows]
    if not trials:
        raise StudyError("these experiments have no completed trial with samples; choose others")
    cutoff_hz = material.dataset.cutoff_hz
    with lab_errors():
        found = fit_streamed(fit, (piece for trial in trials for piece in _pieces(store, trial, cutoff_hz)))
    return Refitted(
        study_id=study_id,
        model_id=model.id,
        trials=found.trials,
        samples=found.samples,
        rows=found.rows,
        training=found.training,
        held_out=found.held_out,
        parameters=_parameters(fit, found.coefficients.tolist()),
        skipped=[f"{name}: {why}" for name, why in found.skipped.items()],
    )


def _pieces(store: Store, trial: Trial, cutoff_hz: float) -> Iterator[Recording]:
    """A trial as the lab wants it; a long one in pieces, each read when it is its turn."""
    name = f"{trial.name} (trial {trial.id})"
    channels = list(trial.channels)
    clock = channels.index("time_s")
    first = store.part(trial, 0, PIECE_ROWS)
    steps = np.diff(first[clock])
    rate_hz = 1.0 / float(np.median(steps)) if len(steps) else 1.0
    for start in piece_starts(trial.rows, rate_hz, cutoff_hz) if trial.rows > PIECE_ROWS else (0,):
        rows = first if start == 0 else store.part(trial, start, PIECE_ROWS)
        later = later_by(trial.conditions, float(rows[clock][0] - first[clock][0])) if start else dict(trial.conditions)
        measured = {
            channel: values for channel, values in zip(channels, rows, strict=True) if not np.isnan(values).all()
        }
        yield Recording(name, trial.kind, later, measured)


def _parameters(fit: Fit, coefficients: list[float]) -> list[RefittedParameter]:
    """Every linear parameter, on the study's trials and on all."""
    unit, facts = fit.dataset.effort_definition.unit, fit.dataset.facts
    named = [(term.effect, parameter) for term in fit.terms for parameter in term.effect.parameters]
    return [
        RefittedParameter(
            effect=effect.name,
            name=parameter.name,
            unit=parameter.unit_in(unit, facts.position_unit),
            study=before,
            all=after,
        )
        for (effect, parameter), before, after in zip(named, fit.coefficients.tolist(), coefficients, strict=True)
    ]
