"""Intervals of a fitted model's parameters, by leaving out whole trials (delete-one jackknife)."""

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from compensator.lab.effects.effect import shape_parameters
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import Bounds, solve_without
from compensator.lab.model.tangents import tangents
from compensator.lab.model.validation import independent_units
from compensator.lab.recordings.recording import FloatArray

CONFIDENCE = 0.95
INERTIA = "inertia"
NOISE = "the acceleration is hardly more than noise of the position: these trials do not tell it"
LEAST_ACCELERATION = 1.0  # over noise of the position, by power: less is what the noise has by chance


@dataclass(frozen=True, slots=True)
class ParameterEstimate:
    """One coefficient with its 95 % interval.

    Attributes:
        effect: name; parameter: name.
        value, low, high: in `unit`; NaN where the data do not determine it.
        note: "" or why the value is to be read with care.
    """

    effect: str
    parameter: str
    unit: str
    value: float
    low: float
    high: float
    note: str


def estimates(fit: Fit) -> list[ParameterEstimate]:
    """Every coefficient and every shape value of the model, in order."""
    half = _half_widths(fit)
    excited = np.any(fit.columns != 0.0, axis=0)
    unit = fit.dataset.effort_definition.unit
    found, index = [], 0
    for term in fit.terms:
        noise = term.effect.name == INERTIA and acceleration_over_noise(fit) < LEAST_ACCELERATION
        for position, parameter in enumerate(term.effect.parameters):
            if not excited[index]:
                index += 1
                continue  # a term for loads, say, where none is hung
            value = float(term.coefficients[position])
            kept, bound = bool(term.kept[position]) and not noise, bool(term.at_bound[position])
            width, lowest, highest = half[index], float(fit.bounds.low[index]), float(fit.bounds.high[index])
            found.append(
                ParameterEstimate(
                    effect=term.effect.name,
                    parameter=parameter.name,
                    unit=parameter.unit_in(unit, fit.dataset.facts.position_unit),
                    value=value if kept else float("nan"),
                    low=max(value - width, lowest) if kept else float("nan"),
                    high=min(value + width, highest) if kept else float("nan"),
                    note=NOISE if noise else _note(kept, bound),
                )
            )
            index += 1
        named = shape_parameters(term.effect.shape_names, term.effect.shape_units)
        for one, number in zip(named, term.shape, strict=True):
            shown = one.unit_in(unit, fit.dataset.facts.position_unit)
            found.append(ParameterEstimate(term.effect.name, one.name, shown, number, float("nan"), float("nan"), ""))
    return found


def acceleration_over_noise(fit: Fit) -> float:
    """Power of the acceleration in the rows of a model with inertia, over that of noise of the position in it.

    Noise of density S [position^2/Hz] is one of acceleration of S (2 pi f)^4, up to the cut-off.
    """
    dataset, place = fit.dataset, 0
    for term in fit.terms:
        if term.effect.name == INERTIA:
            break
        place += len(term.coefficients)
    densities = np.array([trial.signals.position_noise for trial in dataset.trials])
    noise = densities[dataset.trial_index[fit.training]] * (2.0 * np.pi) ** 4 * dataset.cutoff_hz**5 / 5.0
    return float(np.sum(fit.columns[fit.training, place] ** 2) / max(float(np.sum(noise)), np.finfo(float).tiny))


def _note(kept: bool, bound: bool) -> str:
    if not kept:
        return "these trials cannot tell it apart from the parameters before it"
    return "held by its physical bound" if bound else ""


def _half_widths(fit: Fit) -> FloatArray:
    """Half widths of the intervals of all coefficients, shape (K,); NaN where there are too few units."""
    errors, count = standard_errors(fit)
    half: FloatArray = errors * stdtrit(max(count - 1, 1), 0.5 + 0.5 * CONFIDENCE)
    return half


def standard_errors(fit: Fit) -> tuple[FloatArray, int]:
    """Of all coefficients, shape (K,), NaN where they are not known; and how many independent units tell them.

    To find the shapes anew, too, makes no coefficient surer; only bounds can make it seem so.
    """
    held, found = without_each(fit), without_each(fit, tangents(fit))
    errors, count = np.full(held.shape[1], np.nan), len(held)
    if count > 2:
        kept = np.concatenate([term.kept for term in fit.terms])
        errors[kept] = np.maximum(*(np.sqrt(count - 1.0) * np.std(one, axis=0) for one in (held, found)))[kept]
    return errors, count


def without_each(fit: Fit, beside: FloatArray | None = None) -> FloatArray:
    """Coefficients with each independent unit left out in turn, shape (units, K); 0 where not kept.

    Args:
        fit: of the model.
        beside: more columns (N, m) that are fitted, as tangents of the shapes: how fast Stribeck friction falls, and
            what Coulomb friction remains, are known together or not at all.
    """
    kept = np.concatenate([term.kept for term in fit.terms])
    columns, effort = fit.training_equations
    columns, bounds = columns[:, kept], fit.bounds.of(kept)
    if beside is not None:
        columns = np.column_stack([columns, fit.weight[fit.training, None] * beside[fit.training]])
        free = np.full(beside.shape[1], np.inf)
        bounds = Bounds(np.concatenate([bounds.low, -free]), np.concatenate([bounds.high, free]))
    unit = independent_units(fit, fit.training)
    gram, moment = columns.T @ columns, columns.T @ effort
    labels = np.unique(unit)
    without = np.zeros((len(labels), len(kept)))
    for row, label in enumerate(labels):
        inside, own = columns[unit == label], effort[unit == label]
        found = solve_without((gram, moment), (inside.T @ inside, inside.T @ own), bounds)
        without[row, kept] = found[: kept.sum()]
    return without
