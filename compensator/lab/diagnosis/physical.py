"""Whether what explains something can be the effect: its size, its sign, its shape."""

import numpy as np

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Parameter, shape_parameters
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence

UNSURE = 2.0  # standard errors: a coefficient so near to a bound may lie on either side of it
TOLD = "the rig tells of as much already"
ROUNDING = 1e-6  # of a shape that was looked for by its logarithm


def why_not_physical(gathered: Candidates, item: Evidence) -> str:
    """Why size, sign or shape are such that it cannot be the effect, in words; empty where it can."""
    if is_past_scan(gathered, item):
        return f"{_shape(gathered, item, int(np.argmax(_past(gathered, item))))} is the most that it can be"
    if is_before_scan(gathered, item):
        return f"{_shape(gathered, item)} is the least that it can be"
    return why_not_possible(gathered, item)


def why_impossible(fit: Fit, name: str) -> str:
    """Why what a fitted model has of an effect cannot be it, in words; empty where it can.

    A shape near reversals may be one that the owner told of. A coefficient that its lower bound holds would be less
    than the effect can be.
    """
    term = next(term for term in fit.terms if term.effect.name == name)
    least = [low for low, _ in term.effect.ranges_in(fit.dataset.effort_definition.quantity)]
    if term.effect.told(fit.dataset.facts, term.shape):
        return TOLD
    if np.any(term.at_bound & (term.coefficients <= least)):
        return "it would have to be less than it can be"
    if term.effect.holds is not None and not term.effect.holds(term.shape):
        return "of this shape it is something else"
    return ""


def why_not_possible(gathered: Candidates, item: Evidence) -> str:
    """Why the freely fitted coefficients cannot be the effect's, in words; empty where they can.

    They are within bounds, and as large as what they stand in the place of. What the owner tells of is not missing.
    """
    if not is_within_bounds(gathered, item):
        return f"it would be {_size(gathered, item)}"
    if is_too_small(gathered, item):
        return f"it would be under {effect_named(item.block.name).least_of_friction:.0%} of dry friction"
    if is_told(gathered, item):
        return f"{TOLD} ({_shape(gathered, item)})"
    return ""


def _shape(gathered: Candidates, item: Evidence, at: int = 0) -> str:
    """A value of its shape, in words."""
    effect = effect_named(item.block.name)
    one = shape_parameters(effect.shape_names, effect.shape_units)[at]
    return f"{one.name} {_with_unit(gathered, item.block.shape[at], one)}"


def _size(gathered: Candidates, item: Evidence) -> str:
    """Its coefficients that are beyond what they can be, freely fitted, in words."""
    effect = effect_named(item.block.name)
    ranges = effect.ranges_in(gathered.fit.dataset.effort_definition.quantity)
    found = gathered.bases[item.block.base].coefficients(item.block.columns)
    return ", ".join(
        f"{_with_unit(gathered, value, one)}, allowed {low:.3g} {'or more' if np.isinf(high) else f'to {high:.3g}'}"
        for one, value, (low, high) in zip(effect.parameters, found, ranges, strict=True)
        if not low <= value <= high
    )


def _with_unit(gathered: Candidates, value: float, parameter: Parameter) -> str:
    dataset = gathered.fit.dataset
    unit = parameter.unit_in(dataset.effort_definition.unit, dataset.facts.position_unit)
    return f"{value:.3g}" if unit in ("", "1") else f"{value:.3g} {unit}"


def is_told(gathered: Candidates, item: Evidence) -> bool:
    """Whether the owner tells of so much of it."""
    return effect_named(item.block.name).told(gathered.fit.dataset.facts, item.block.shape)


def is_within_bounds(gathered: Candidates, item: Evidence) -> bool:
    """Whether the freely fitted coefficients lie within the effect's bounds, as far as the rows can tell."""
    ranges = effect_named(item.block.name).ranges_in(gathered.fit.dataset.effort_definition.quantity)
    found = gathered.bases[item.block.base].coefficients(item.block.columns)
    unsure = UNSURE * _standard_error(item, found)
    return all(low - unsure <= c <= high + unsure for (low, high), c in zip(ranges, found, strict=True))


def is_too_small(gathered: Candidates, item: Evidence) -> bool:
    """Whether an effect that stands in the place of dry friction is but a part of it."""
    least = effect_named(item.block.name).least_of_friction * gathered.fit.dry_friction
    return least > 0.0 and bool(np.all(gathered.bases[item.block.base].coefficients(item.block.columns) < least))


def is_past_scan(gathered: Candidates, item: Evidence) -> bool:
    """Whether the shape lies at an upper end of a scan of all that the effect can be: what fits there goes on."""
    return bool(np.any(_past(gathered, item)))


def _past(gathered: Candidates, item: Evidence) -> BoolArray:
    """Which of the shape's first values lie there, shape (values,)."""
    ends, within = _scanned(gathered, item), effect_named(item.block.name).ends_within_scan
    if len(ends) == 0:
        return np.zeros(0, dtype=bool)
    shape = np.array(item.block.shape)[:within]
    past: BoolArray = shape >= (1.0 - ROUNDING) * np.max(ends, axis=0)[:within]
    return past


def is_before_scan(gathered: Candidates, item: Evidence) -> bool:
    """Whether the shape lies at the lower end of a scan of all that the effect can be, in all values.

    There something shorter fits as well, and it cannot be told from what the measuring chain makes of a sign.
    """
    ends, effect = _scanned(gathered, item), effect_named(item.block.name)
    if len(ends) == 0:
        return False
    within = effect.ends_within_scan
    return bool(np.all(np.array(item.block.shape)[:within] <= (1.0 + ROUNDING) * np.min(ends, axis=0)[:within]))


def _scanned(gathered: Candidates, item: Evidence) -> FloatArray:
    """Shapes (s, values) that a scan of all that the effect can be holds; none where a scan does not hold all."""
    effect = effect_named(item.block.name)
    if not effect.ends_within_scan or not item.block.shape:
        return np.empty((0, 0))
    return np.array(effect.shapes(gathered.fit.dataset.trials[0].motion))


def _standard_error(item: Evidence, coefficients: FloatArray) -> float:
    """Of a coefficient that stands alone: its evidence is the square of how many of them it is; 0 beside others."""
    alone = len(coefficients) == 1 and item.noncentrality > 0.0
    return float(abs(coefficients[0]) / np.sqrt(item.noncentrality)) if alone else 0.0
