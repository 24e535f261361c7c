"""Measured against predicted, as JSON for the page, the command line and reports."""

from typing import Any

import numpy as np

from bench.store import Store
from bench.study.material import Material, load_model
from compensator.lab.at_rest.breakaway_comparison import breakaway_estimates
from compensator.lab.at_rest.rest_comparison import at_rest_in_words
from compensator.lab.chance import stated
from compensator.lab.comparison import comparison
from compensator.lab.comparison.null_space import left_open
from compensator.lab.diagnosis.data_checks import data_problems
from compensator.lab.diagnosis.run_to_run import by_run_in_words, differences_by_run
from compensator.lab.model.fitted import Fit
from compensator.lab.model.intervals import ParameterEstimate, estimates
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.drivers import DRIVERS

SERIES_POINTS = 600  # of each trial in the answer; the fit uses all rows


def compare(store: Store, study_id: int, model_id: int | None = None) -> dict[str, Any]:
    """Hold a model of a study against its trials.

    Args:
        store: with the study.
        study_id: which study.
        model_id: which model; None takes the newest.

    Raises:
        StudyError: no such model, or the trials cannot be used.
    """
    material, model = load_model(store, study_id, model_id)
    fit = material.fit_of(model)
    found = comparison.compare(fit)
    parameters = estimates(fit)
    return {
        "study_id": study_id,
        "model_id": model.id,
        "effects": model.effects,
        "parameters": _parameters(parameters),
        "effort": material.effort,
        "error": {
            "training": _error(found.training),
            "held_out": {
                "rms": found.held_out.rms,
                "relative": found.held_out.relative,
                "kind": found.held_out.kind,
            },
            "floor": _error(found.floor) if found.floor else None,
        },
        "trials": _trials(material, found),
        "regimes": [{"name": regime.name, "rows": regime.rows, **_error(regime)} for regime in found.regimes],
        "at_rest": _at_rest(found),
        "breakaway": _breakaway(found),
        "series": _series(material, fit),
        "residual_against": _against(material, found),
        "notes": [*_notes(material, found), *(f"{one}." for one in left_open(fit, parameters))],
    }


def _error(error: comparison.ErrorOf) -> dict[str, float]:
    return {"rms": error.rms, "relative": error.relative}


def _at_rest(found: comparison.Comparison) -> dict[str, Any] | None:
    if found.at_rest is None:
        return None
    one = found.at_rest
    return {
        "stretches": one.windows,
        "rests": one.rests,
        "outside": one.outside,
        "largest": one.largest,
        "sides": [
            {
                "side": name,
                "outside": side.outside,
                "largest": side.largest,
                "p_value": stated(side.chance),
                "trial": side.trial,
                "time_s": side.time_s,
            }
            for name, side in (("above", one.above), ("below", one.below))
        ],
        "static_friction_from": "starts" if one.by_starts else "sliding",
        "sentence": at_rest_in_words(one, found.fit.dataset.effort_definition.unit),
    }


def _breakaway(found: comparison.Comparison) -> dict[str, Any] | None:
    if found.breakaway is None:
        return None
    one = found.breakaway
    return {
        "starts": one.starts,
        "training": {"rms": one.rms, "relative": one.relative},
        "held_out": {"rms": one.held_out.rms, "relative": one.held_out.relative, "kind": one.held_out.kind},
        "parameters": _parameters(breakaway_estimates(one.fit)),
    }


def _parameters(found: list[ParameterEstimate]) -> list[dict[str, Any]]:
    return [
        {
            "effect": one.effect,
            "name": one.parameter,
            "value": one.value,
            "unit": one.unit,
            "low": one.low,
            "high": one.high,
            "note": one.note,
        }
        for one in found
    ]


def _trials(material: Material, found: comparison.Comparison) -> list[dict[str, Any]]:
    return [
        {
            "trial_id": trial.id,
            "name": trial.name,
            "role": "held_out" if held else "training",
            "conditions": trial.conditions,
            **_error(error),
        }
        for trial, held, error in zip(material.trials, material.definition.held_out, found.trials, strict=True)
    ]


def _series(material: Material, fit: Fit) -> list[dict[str, Any]]:
    dataset, series = fit.dataset, []
    for index, (trial, prepared) in enumerate(zip(material.trials, dataset.trials, strict=True)):
        rows = np.flatnonzero(dataset.trial_index == index)
        chosen = rows[:: max(1, len(rows) // SERIES_POINTS)]
        time = dataset.time_of(prepared)[chosen - rows[0]] if len(rows) else np.empty(0)
        series.append(
            {
                "trial_id": trial.id,
                "name": trial.name,
                "time_s": _list(time),
                "measured": _list(dataset.effort[chosen]),
                "predicted": _list(fit.predicted[chosen]),
                "residual": _list(fit.residual[chosen]),
            }
        )
    return series


def _against(material: Material, found: comparison.Comparison) -> list[dict[str, Any]]:
    by_driver: dict[str, list[dict[str, Any]]] = {}
    for one in found.against:
        bins = one.bins
        by_driver.setdefault(one.driver, []).append(
            {
                "direction": one.direction,
                "x": _list(bins.x),
                "mean": _list(bins.mean),
                "low": _list(bins.low),
                "high": _list(bins.high),
                "count": bins.count.tolist(),
            }
        )
    unit = material.dataset.effort_definition.unit
    facts = material.definition.facts
    return [
        {"driver": driver, "unit": DRIVERS[driver].unit_in(unit, facts), "groups": groups}
        for driver, groups in by_driver.items()
    ]


def _notes(material: Material, found: comparison.Comparison) -> list[str]:
    rows = {"sliding": "where the joint slides", "moving": "where the joint moves", "all": "everywhere"}
    notes = [
        f"Errors count {int(material.dataset.counted.sum())} rows {rows[material.definition.rows]}, effort and motion "
        f"filtered alike at {material.definition.cutoff_hz:.3g} Hz."
    ]
    notes += [f"Data: {problem}." for problem in data_problems(found.fit)]
    if material.dataset.crosses_free_play:
        notes.append(
            "The motion is so quick that the teeth cross their free play all the time: those rows are counted too, and "
            "the error is mostly theirs. Record slower motion, or keep the load on one side."
        )
    if found.held_out.kind == "leave-one-block-out":
        notes.append("Too few trials to hold one out: stretches of 2 s are left out instead, which flatters the model.")
    if found.floor is None:
        notes.append("No trial repeats another: how well any model could do is unknown. Repeat at least one trial.")
    unit = material.dataset.effort_definition.unit
    by_run = differences_by_run(found.fit, found.held_out)
    return [*notes, *(by_run_in_words(one, unit) for one in by_run)]


def _list(values: FloatArray) -> list[float]:
    listed: list[float] = values.tolist()
    return listed
