"""A model of a study under the control law that its trials ran under: error of motion beside that of effort."""

from collections.abc import Iterator

import numpy as np
from pydantic import ValidationError

from bench.config.rig import Rig
from bench.config.sections import ServoSettings
from bench.store import Store
from bench.store.records import Experiment, ModelRow
from bench.study.errors import StudyError, lab_errors
from bench.study.keep import kept_of, stored
from bench.study.material import Material, load_model
from bench.study.models.closed_loop import ClosedLoop, Coefficient, LoopError, Motion, Refined, TrialInLoop
from bench.study.models.kept import KeptMotion
from bench.study.models.stages import CLOSED_LOOP, FITTING, MOVING
from bench.study.suggestion.dynamics import drive_of
from compensator.lab import progress
from compensator.lab.closed_loop import loop_comparison as lab
from compensator.lab.closed_loop.control_law import ControlLaw
from compensator.lab.closed_loop.refinement import Refinement, refine
from compensator.lab.model.fit import seeing_all, with_coefficients
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import relative_error
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Trial

SERIES_POINTS = 300  # of each trial in the answer; the errors use all samples


@progress.stages(CLOSED_LOOP)
def simulate(store: Store, study_id: int, model_id: int | None = None, refined: bool = False) -> ClosedLoop:
    """Move a model's joint through the study's trials, under the servo that they ran under.

    Args:
        store: with the study.
        study_id: which study.
        model_id: which model; None takes the newest.
        refined: refine the coefficients by it, too; nothing of that is kept.

    Raises:
        NotFoundError, StudyError: as `load_model`; or the model has no inertia.
    """
    material, model = load_model(store, study_id, model_id)
    progress.enter(FITTING)
    fit = seeing_all(material.fit_of(model))  # the joint stands and turns on its way
    progress.enter(MOVING)
    laws = _laws(store, material, fit)
    with lab_errors():
        refinement = refine(fit, laws) if refined else None
        found = lab.compare_in_loop(fit, laws) if refinement is None else refinement.before
    unit = material.definition.facts.position_unit
    return ClosedLoop(
        study_id=study_id,
        model_id=model.id,
        effects=model.effects,
        effort=material.effort,
        position_unit=unit,
        training=LoopError.model_validate(found.training),
        held_out=None if found.held_out is None else LoopError.model_validate(found.held_out),
        trials=[_trial(material, fit, index, one) for index, one in enumerate(found.trials)],
        refined=None if refinement is None else _refined(fit, refinement, unit),
        notes=list(_notes(found)),
    )


def keep_motion_errors(store: Store, study_id: int) -> Iterator[int]:
    """Simulate every model of a study that was not yet, and keep its errors with it, for the ladder.

    Yields:
        The number of each model, once it is kept.

    Raises:
        NotFoundError, StudyError: as `simulate`.
    """
    for row in store.models(study_id):
        if kept_of(row).closed_loop is None:
            keep_motion_error(store, study_id, row)
            yield row.id


def keep_motion_error(store: Store, study_id: int, row: ModelRow) -> None:
    """Simulate one model, and keep its errors with it. Errors as `simulate`."""
    found = simulate(store, study_id, row.id)
    motion = KeptMotion(training=found.training, held_out=found.held_out, position_unit=found.position_unit)
    kept = kept_of(store.model(row.id))
    store.change_model(row.id, stored(kept.model_copy(update={"closed_loop": motion})))


def _laws(store: Store, material: Material, fit: Fit) -> list[ControlLaw | None]:
    """What the bench says of its servo, for each trial whose position loop it closed itself."""
    by_experiment = {trial.experiment_id: None for trial in material.trials}
    known = {number: _law(store.experiment(number), fit) for number in by_experiment}
    return [known[trial.experiment_id] for trial in material.trials]


def _law(experiment: Experiment, fit: Fit) -> ControlLaw | None:
    told = experiment.provenance.get("configuration", {}).get("servo")
    try:
        settings = ServoSettings.model_validate(told)
        drive = drive_of(fit, Rig.model_validate(experiment.rig))
    except (ValidationError, StudyError):
        return None  # an imported recording, or nobody says what a current is worth: the recording may tell the law
    if settings.closed_by != "bench":
        return None
    return ControlLaw(
        stiffness=drive.per_a * settings.proportional_a_rad,
        integral=drive.per_a * settings.integral_a_rad_s,
        # a voltage holds the back-EMF, which goes with the speed of the joint and against the servo's damping
        damping=drive.per_a * settings.derivative_a_s_rad - drive.per_rad_s,
        source="bench",
        dead_band=settings.dead_band_rad,
    )


def _trial(material: Material, fit: Fit, index: int, one: lab.TrialInLoop) -> TrialInLoop:
    trial = material.trials[index]
    return TrialInLoop(
        **dict(LoopError.model_validate(one.error)),
        trial_id=trial.id,
        name=trial.name,
        role="held_out" if one.held_out else "training",
        law=one.source,
        settled=one.settled,
        series=_series(fit.dataset.trials[index], one.simulated.position),
    )


def _series(trial: Trial, simulated: FloatArray) -> Motion:
    signals = trial.signals
    chosen = slice(None, None, max(1, len(simulated) // SERIES_POINTS))
    return Motion(
        time_s=(signals.time_s - signals.time_s[0])[chosen].tolist(),
        measured=signals.position[chosen].tolist(),
        simulated=simulated[chosen].tolist(),
    )


def _refined(fit: Fit, refinement: Refinement, unit: str) -> Refined:
    after = refinement.fit
    coefficients = fit.coefficients if after is None else after.coefficients
    along_measured = with_coefficients(fit, coefficients)
    rows = fit.dataset.counted
    effort = fit.dataset.effort[rows]
    held_out = refinement.after.held_out
    return Refined(
        training=LoopError.model_validate(refinement.after.training),
        held_out=None if held_out is None else LoopError.model_validate(held_out),
        passes=refinement.passes,
        gained=after is not None,
        inverse_before=relative_error(fit.residual[rows], effort),
        inverse_after=relative_error(along_measured.residual[rows], effort),
        parameters=_coefficients(fit, coefficients),
        sentence=_sentence(refinement, unit),
    )


def _coefficients(fit: Fit, refined: FloatArray) -> list[Coefficient]:
    """Before and after, of those that the trials excite."""
    named = [(term.effect, parameter) for term in fit.terms for parameter in term.effect.parameters]
    excited = np.any(fit.columns != 0.0, axis=0)
    return [
        Coefficient(
            effect=effect.name,
            name=parameter.name,
            unit=parameter.unit_in(fit.dataset.effort_definition.unit, fit.dataset.facts.position_unit),
            before=old,
            after=new,
        )
        for (effect, parameter), old, new, used in zip(
            named, fit.coefficients.tolist(), refined.tolist(), excited.tolist(), strict=True
        )
        if used
    ]


def _sentence(refinement: Refinement, unit: str) -> str:
    if refinement.fit is None:
        return (
            f"Refinement gains nothing in {refinement.passes} passes: along the simulated motion no coefficients "
            "lower the error of the effort in closed loop."
        )
    before, after = refinement.before, refinement.after
    judged, kind = (before.training, after.training), "on the trials that it was fitted to"
    if before.held_out is not None and after.held_out is not None:
        judged, kind = (before.held_out, after.held_out), "held out"
    return (
        f"Refined in {refinement.passes} passes: in closed loop the error of the position goes from "
        f"{judged[0].position:.3g} to {judged[1].position:.3g} {unit}, that of the effort from "
        f"{judged[0].effort_relative:.2%} to {judged[1].effort_relative:.2%}, {kind}. "
        + ("It helps." if judged[1].effort < judged[0].effort else "It does not help there: least squares are better.")
    )


def _notes(found: lab.LoopComparison) -> Iterator[str]:
    alone = [one.name for one in found.trials if one.source == "stand-in"]
    if alone:
        yield (
            f"{_some(alone)} tells no control law (no set point, or an effort that no linear law explains): a servo of "
            "twice the motion's bandwidth stands in, so that its error is not the one of that joint's own servo."
        )
    restless = [one.name for one in found.trials if not one.settled]
    if restless:
        yield (
            f"{_some(restless)} did not settle: friction decides there, by less than the model knows, where the joint "
            "stops; the error is known to a few per cent only."
        )
    if found.left_out:
        yield f"Effects of the measuring chain move nothing and are left out: {', '.join(found.left_out)}."
    if found.held_out is None:
        yield "Too few trials to leave one out in turn: errors are of the trials that the model was fitted to."


def _some(names: list[str]) -> str:
    if len(names) <= 3:
        return f"Trial {', '.join(names)}" if len(names) == 1 else f"Each of {', '.join(names)}"
    return f"Each of {len(names)} trials ({', '.join(names[:2])}, ...)"
