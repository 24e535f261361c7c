"""Measured against predicted, for the page, the command line and reports."""

from math import isnan
from typing import Literal

from bench.store import Store
from bench.study.diagnosis.findings import findings_of_trials
from bench.study.joint import joint_of
from bench.study.material import Material, load_model
from bench.study.models.comparison import (
    AtRest,
    BeyondFriction,
    BreakawayError,
    Comparison,
    DriverGroup,
    Error,
    Errors,
    FittedParameter,
    RegimeError,
    ResidualAgainst,
    TrialError,
)
from bench.study.models.stages import COMPARING, COMPARISON, FITTING, INTERVALS
from bench.study.plots.series import series_of
from compensator.lab import progress
from compensator.lab.at_rest.breakaway_comparison import breakaway_estimates
from compensator.lab.at_rest.rest_comparison import Side, at_rest_in_words
from compensator.lab.chance import stated
from compensator.lab.comparison import comparison
from compensator.lab.comparison.null_space import left_open
from compensator.lab.diagnosis.data_checks import data_problems
from compensator.lab.diagnosis.run_to_run import by_run_in_words, differences_by_run
from compensator.lab.model.intervals import ParameterEstimate, estimates
from compensator.lab.rows.drivers import DRIVERS


@progress.stages(COMPARISON)
def compare(store: Store, study_id: int, model_id: int | None = None) -> Comparison:
    """Hold a model of a study against its trials.

    Raises:
        StudyError: no such model, or the trials cannot be used.
    """
    material, model = load_model(store, study_id, model_id)
    progress.enter(FITTING)
    fit = material.fit_of(model)
    progress.enter(COMPARING)
    found = comparison.compare(fit)
    progress.enter(INTERVALS)
    parameters = estimates(fit)
    told = findings_of_trials(fit, joint_of(store, material.definition))
    notes = [*(one.text for one in told), *_notes(material, found), *(f"{one}." for one in left_open(fit, parameters))]
    return Comparison(
        study_id=study_id,
        model_id=model.id,
        effects=model.effects,
        parameters=fitted_parameters(parameters),
        effort=material.effort,
        error=Errors(
            training=Error.model_validate(found.training),
            held_out=Error.model_validate(found.held_out),
            floor=Error.model_validate(found.floor) if found.floor else None,
        ),
        trials=_trials(material, found),
        regimes=[RegimeError.model_validate(one) for one in found.regimes],
        at_rest=_at_rest(found),
        breakaway=_breakaway(found),
        series=series_of(material, fit),
        residual_against=_against(material, found),
        notes=notes,
        findings=told,
    )


def _at_rest(found: comparison.Comparison) -> AtRest | None:
    if found.at_rest is None:
        return None
    one = found.at_rest
    return AtRest(
        stretches=one.windows,
        rests=one.rests,
        outside=one.outside,
        largest=one.largest,
        sides=[_beyond("above", one.above), _beyond("below", one.below)],
        static_friction_from="starts" if one.by_starts else "sliding",
        sentence=at_rest_in_words(one, found.fit.dataset.effort_definition.unit),
    )


def _beyond(name: Literal["above", "below"], side: Side) -> BeyondFriction:
    return BeyondFriction(
        side=name,
        outside=side.outside,
        largest=side.largest,
        p_value=stated(side.chance),
        trial=side.trial,
        time_s=side.time_s,
    )


def _breakaway(found: comparison.Comparison) -> BreakawayError | None:
    if found.breakaway is None:
        return None
    one = found.breakaway
    return BreakawayError(
        starts=one.starts,
        training=Error.model_validate(one),
        held_out=Error.model_validate(one.held_out),
        parameters=fitted_parameters(breakaway_estimates(one.fit)),
    )


def fitted_parameters(found: list[ParameterEstimate]) -> list[FittedParameter]:
    """Estimates as an answer has them."""
    return [
        FittedParameter(
            effect=one.effect,
            name=one.parameter,
            value=one.value,
            unit=one.unit,
            low=one.low,
            high=one.high,
            note=one.note,
        )
        for one in found
    ]


def _trials(material: Material, found: comparison.Comparison) -> list[TrialError]:
    return [
        TrialError(**dict(trial), rms=error.rms, relative=error.relative)
        for trial, error in zip(material.study_trials, found.trials, strict=True)
    ]


def _against(material: Material, found: comparison.Comparison) -> list[ResidualAgainst]:
    by_driver: dict[str, list[DriverGroup]] = {}
    for one in found.against:
        bins = one.bins
        by_driver.setdefault(one.driver, []).append(
            DriverGroup(
                direction=one.direction,
                x=bins.x.tolist(),
                mean=bins.mean.tolist(),
                low=bins.low.tolist(),
                high=bins.high.tolist(),
                count=bins.count.tolist(),
            )
        )
    unit = material.dataset.effort_definition.unit
    facts = material.definition.facts
    return [
        ResidualAgainst(driver=driver, unit=DRIVERS[driver].unit_in(unit, facts), groups=groups)
        for driver, groups in by_driver.items()
    ]


def _notes(material: Material, found: comparison.Comparison) -> list[str]:
    rows = {"sliding": "where the joint slides", "moving": "where the joint moves", "all": "everywhere"}
    notes = [
        f"Errors count {int(material.dataset.counted.sum())} rows {rows[material.definition.rows]}, effort and motion "
        f"filtered alike at {material.definition.cutoff_hz:.3g} Hz."
    ]
    if without := sum(isnan(one.rms) for one in found.trials):
        notes.append(f"{without} of {len(found.trials)} trials have no such row, and no error of their own.")
    notes += [f"Data: {problem}." for problem in data_problems(found.fit)]
    if material.dataset.crosses_free_play:
        notes.append(
            "The motion is so quick that the teeth cross their free play all the time: those rows are counted too, and "
            "the error is mostly theirs. Record slower motion, or keep the load on one side."
        )
    if found.floor is None:
        notes.append("No trial repeats another: how well any model could do is unknown. Repeat at least one trial.")
    unit = material.dataset.effort_definition.unit
    by_run = differences_by_run(found.fit, found.held_out)
    return [*notes, *(by_run_in_words(one, unit) for one in by_run)]
