"""Whether what explains something can be the effect: its size, its sign, its shape."""

from typing import NamedTuple

import numpy as np

from compensator.lab.effects.effect import Effect, Parameter, Shape, shape_parameters
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import Term
from compensator.lab.rows.dataset import Dataset

TOLD = "known from the rig"
VISCOUS = "viscous"
END_OF_SCAN, SIGN, SIZE, SMALL = "limit of the scan", "unphysical sign", "unphysical size", "too small"
ROUNDING = 1e-6  # of a shape that was looked for by its logarithm


class Impossible(NamedTuple):
    """Why something cannot be the effect: in words, and in two or three of them; both empty where it can."""

    words: str
    badge: str


POSSIBLE = Impossible("", "")


def why_impossible(fit: Fit, name: str) -> Impossible:
    """Why what a fitted model has of an effect cannot be it.

    Its shape lies at an end of a scan of all that it can be; a bound holds a coefficient, which would be less than it
    can be, or of the other sign; it is but a part of what it stands in the place of; or the owner tells of it.
    """
    term = next(term for term in fit.terms if term.effect.name == name)
    effect, dataset = term.effect, fit.dataset
    if end := _end_of_scan(effect, dataset, term.shape):
        return Impossible(end, END_OF_SCAN)
    if effect.told(dataset.facts, term.shape):
        return Impossible(f"{TOLD} ({_shape(effect, dataset, term.shape)})", TOLD)
    if held := _held(dataset, term):
        return held
    least = effect.least_of_friction * fit.dry_friction
    if least > 0.0 and np.all(term.coefficients < least):
        return Impossible(f"it would be under {effect.least_of_friction:.0%} of dry friction", SMALL)
    if effect.holds is not None and not effect.holds(term.shape, _of_friction(fit, term)):
        return Impossible("of this shape it is something else", END_OF_SCAN)
    return POSSIBLE


def _of_friction(fit: Fit, term: Term) -> float:
    """What a term's dry and viscous parts come to at the fast speeds, over all friction of the model there."""
    fast = fit.dataset.trials[0].motion.fast
    there = fit.dry_friction + fast * sum(float(one.coefficients[0]) for one in fit.terms if one.effect.name == VISCOUS)
    return float(np.polynomial.polynomial.polyval(fast, term.coefficients)) / there if there > 0.0 else np.inf


def _held(dataset: Dataset, term: Term) -> Impossible | None:
    """That bounds hold all coefficients that would be less, or of the other sign; None where one is not held so."""
    ranges = term.effect.ranges_in(dataset.effort_definition.quantity)
    lowest = [value <= low for value, (low, _) in zip(term.coefficients, ranges, strict=True)]
    wrong = np.array(lowest) | (term.coefficients == 0.0)
    if not np.all(term.at_bound & wrong):
        return None
    parameter, value, way = term.effect.parameters[0], term.coefficients[0], "less" if lowest[0] else "more"
    words = f"its {parameter.name} would have to be {way} than {_with_unit(dataset, value, parameter)}"
    return Impossible(words, SIZE if value else SIGN)


def _shape(effect: Effect, dataset: Dataset, shape: Shape, at: int = 0) -> str:
    """A value of its shape, in words."""
    one = shape_parameters(effect.shape_names, effect.shape_units)[at]
    return f"{one.name} {_with_unit(dataset, shape[at], one)}"


def _with_unit(dataset: Dataset, value: float, parameter: Parameter) -> str:
    unit = parameter.unit_in(dataset.effort_definition.unit, dataset.facts.position_unit)
    return f"{value:.3g}" if unit in ("", "1") else f"{value:.3g} {unit}"


def _end_of_scan(effect: Effect, dataset: Dataset, shape: Shape) -> str:
    """At which end of a scan of all that the effect can be a shape lies, in words; empty where it lies within.

    What fits best at an upper end of any value goes on beyond it. Where its first value, how far, how often or over
    what speed it acts, is the least, something shorter fits as well: it cannot be told from what the measuring chain
    makes of a sign.
    """
    within = effect.ends_within_scan
    if not within or not shape:
        return ""
    ends, own = np.array(effect.shapes(dataset.trials[0].motion))[:, :within], np.array(shape)[:within]
    past = own >= (1.0 - ROUNDING) * np.max(ends, axis=0)
    if np.any(past):
        return f"{_shape(effect, dataset, shape, int(np.argmax(past)))} is the most that it can be"
    if own[0] <= (1.0 + ROUNDING) * np.min(ends[:, 0]):
        return f"{_shape(effect, dataset, shape)} is the least that it can be"
    return ""
