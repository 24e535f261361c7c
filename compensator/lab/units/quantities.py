"""The coefficients of one model that was fitted to several units, as quantities of these units."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import Shape
from compensator.lab.model.fitted import Fit
from compensator.lab.model.intervals import standard_errors
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.units.random_effects import UnitValues

FEWEST_UNITS = 3


@dataclass(frozen=True)
class UnitFit:
    """The coefficients of a model of one unit, shape (K,) each.

    Attributes:
        value: coefficients.
        error: their standard errors; NaN where the trials do not tell.
        freedom: degrees of freedom of the errors.
        usable: which are determined by the trials and not held by a bound.
    """

    value: FloatArray
    error: FloatArray
    freedom: float
    usable: BoolArray


@dataclass(frozen=True)
class Quantity:
    """One coefficient of all units that determine it.

    Attributes:
        effect, parameter, unit: names.
        inside: which units these are, shape (number of units,).
        values: theirs.
    """

    effect: str
    parameter: str
    unit: str
    inside: BoolArray
    values: UnitValues


def unit_fit_of(fit: Fit) -> UnitFit:
    """What a fit says of its unit."""
    error, parts = standard_errors(fit)
    kept = np.concatenate([term.kept & ~term.at_bound for term in fit.terms])
    excited = np.any(fit.columns != 0.0, axis=0)
    return UnitFit(fit.coefficients, error, parts - 1.0, kept & excited & np.isfinite(error))


def quantities_of(fit: Fit, units: Sequence[UnitFit], fewest: int = FEWEST_UNITS) -> tuple[list[Quantity], list[str]]:
    """Every coefficient that enough units determine, and the names of those that fewer do.

    Args:
        fit: of any of the units: its effects and units of measurement are those of all.
        units: all of them, fitted with the same effects and shapes.
        fewest: how many units are enough.
    """
    unit, facts = fit.dataset.effort_definition.unit, fit.dataset.facts
    found, lacking = [], []
    named = [(term.effect, parameter) for term in fit.terms for parameter in term.effect.parameters]
    for index, (effect, parameter) in enumerate(named):
        inside = np.array([one.usable[index] for one in units])
        if inside.sum() < fewest:
            lacking.append(f"{effect.name}, {parameter.name}")
            continue
        chosen = [one for one in units if one.usable[index]]
        values = UnitValues(
            np.array([one.value[index] for one in chosen]),
            np.array([one.error[index] for one in chosen]),
            np.array([one.freedom for one in chosen]),
        )
        found.append(
            Quantity(effect.name, parameter.name, parameter.unit_in(unit, facts.position_unit), inside, values)
        )
    return found, lacking


def shared_shapes(each: Sequence[dict[str, Shape]]) -> dict[str, Shape]:
    """Of each effect the middle one of the units' own shapes: with others, coefficients mean something else."""
    return {name: sorted(one[name] for one in each)[(len(each) - 1) // 2] for name in each[0]}
