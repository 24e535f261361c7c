"""Whether what explains something can be the effect: its size, its sign, its shape."""

import numpy as np

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Effect, Parameter, Shape, shape_parameters
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import EffortQuantity
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence

UNSURE = 2.0  # standard errors: a coefficient so near to a bound may lie on either side of it
TOLD = "known from the rig"
END_OF_SCAN, SIGN, SIZE, SMALL = "limit of the scan", "unphysical sign", "unphysical size", "too small"
ROUNDING = 1e-6  # of a shape that was looked for by its logarithm


def why_not_physical(gathered: Candidates, item: Evidence) -> str:
    """Why size, sign or shape are such that it cannot be the effect, in words; empty where it can."""
    return _end_of_scan(*_shaped(gathered, item)) or why_not_possible(gathered, item)


def badge_of(gathered: Candidates, item: Evidence) -> str:
    """The same in two or three words; empty where it can be the effect."""
    if not why_not_physical(gathered, item):
        return ""
    if _end_of_scan(*_shaped(gathered, item)):
        return END_OF_SCAN
    if not is_within_bounds(gathered, item):
        found = gathered.bases[item.block.base].coefficients(item.block.columns)
        lows = [low for low, _ in effect_named(item.block.name).ranges_in(_quantity(gathered))]
        return SIGN if any(value < 0.0 <= low for value, low in zip(found, lows, strict=True)) else SIZE
    return SMALL if is_too_small(gathered, item) else TOLD


def why_at_end(fit: Fit, name: str) -> str:
    """Why the shape of an effect in a fitted model cannot be its own, in words; empty where it can.

    It lies at an end of a scan of all that the effect can be.
    """
    term = next(term for term in fit.terms if term.effect.name == name)
    return _end_of_scan(term.effect, fit.dataset, term.shape)


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
        return _size(gathered, item)
    if is_too_small(gathered, item):
        return f"it would be under {effect_named(item.block.name).least_of_friction:.0%} of dry friction"
    if is_told(gathered, item):
        return f"{TOLD} ({_shape(*_shaped(gathered, item))})"
    return ""


def _shape(effect: Effect, dataset: Dataset, shape: Shape, at: int = 0) -> str:
    """A value of its shape, in words."""
    one = shape_parameters(effect.shape_names, effect.shape_units)[at]
    return f"{one.name} {_with_unit(dataset, shape[at], one)}"


def _size(gathered: Candidates, item: Evidence) -> str:
    """Its coefficients that are beyond what they can be, freely fitted, in words."""
    effect, dataset, _ = _shaped(gathered, item)
    ranges = effect.ranges_in(_quantity(gathered))
    found = gathered.bases[item.block.base].coefficients(item.block.columns)
    return ", ".join(
        f"its {one.name} would be {_with_unit(dataset, value, one)}, allowed {_range(low, high)}"
        for one, value, (low, high) in zip(effect.parameters, found, ranges, strict=True)
        if not low <= value <= high
    )


def _range(low: float, high: float) -> str:
    if np.isinf(high):
        return f"{low:.3g} or more"
    return f"{high:.3g} or less" if np.isinf(low) else f"{low:.3g} to {high:.3g}"


def _with_unit(dataset: Dataset, value: float, parameter: Parameter) -> str:
    unit = parameter.unit_in(dataset.effort_definition.unit, dataset.facts.position_unit)
    return f"{value:.3g}" if unit in ("", "1") else f"{value:.3g} {unit}"


def is_told(gathered: Candidates, item: Evidence) -> bool:
    """Whether the owner tells of so much of it."""
    return effect_named(item.block.name).told(gathered.fit.dataset.facts, item.block.shape)


def is_within_bounds(gathered: Candidates, item: Evidence) -> bool:
    """Whether the freely fitted coefficients lie within the effect's bounds, as far as the rows can tell."""
    ranges = effect_named(item.block.name).ranges_in(_quantity(gathered))
    found = gathered.bases[item.block.base].coefficients(item.block.columns)
    unsure = UNSURE * _standard_error(item, found)
    return all(low - unsure <= c <= high + unsure for (low, high), c in zip(ranges, found, strict=True))


def is_too_small(gathered: Candidates, item: Evidence) -> bool:
    """Whether an effect that stands in the place of dry friction is but a part of it."""
    least = effect_named(item.block.name).least_of_friction * gathered.fit.dry_friction
    return least > 0.0 and bool(np.all(gathered.bases[item.block.base].coefficients(item.block.columns) < least))


def is_past_scan(gathered: Candidates, item: Evidence) -> bool:
    """Whether the shape lies at an upper end of a scan of all that the effect can be: what fits there goes on."""
    return bool(np.any(_past(*_shaped(gathered, item))))


def is_before_scan(gathered: Candidates, item: Evidence) -> bool:
    """Whether the shape lies at the lower end of a scan of all that the effect can be, in all values.

    There something shorter fits as well, and it cannot be told from what the measuring chain makes of a sign.
    """
    return _before(*_shaped(gathered, item))


def _end_of_scan(effect: Effect, dataset: Dataset, shape: Shape) -> str:
    """At which end of a scan of all that the effect can be a shape lies, in words; empty where it lies within."""
    past = _past(effect, dataset, shape)
    if np.any(past):
        return f"{_shape(effect, dataset, shape, int(np.argmax(past)))} is the most that it can be"
    if _before(effect, dataset, shape):
        return f"{_shape(effect, dataset, shape)} is the least that it can be"
    return ""


def _past(effect: Effect, dataset: Dataset, shape: Shape) -> BoolArray:
    """Which of the shape's first values lie at an upper end, shape (values,)."""
    ends, within = _scanned(effect, dataset, shape), effect.ends_within_scan
    if len(ends) == 0:
        return np.zeros(0, dtype=bool)
    past: BoolArray = np.array(shape)[:within] >= (1.0 - ROUNDING) * np.max(ends, axis=0)[:within]
    return past


def _before(effect: Effect, dataset: Dataset, shape: Shape) -> bool:
    ends, within = _scanned(effect, dataset, shape), effect.ends_within_scan
    if len(ends) == 0:
        return False
    return bool(np.all(np.array(shape)[:within] <= (1.0 + ROUNDING) * np.min(ends, axis=0)[:within]))


def _scanned(effect: Effect, dataset: Dataset, shape: Shape) -> FloatArray:
    """Shapes (s, values) that a scan of all that the effect can be holds; none where a scan does not hold all."""
    if not effect.ends_within_scan or not shape:
        return np.empty((0, 0))
    return np.array(effect.shapes(dataset.trials[0].motion))


def _shaped(gathered: Candidates, item: Evidence) -> tuple[Effect, Dataset, Shape]:
    return effect_named(item.block.name), gathered.fit.dataset, item.block.shape


def _quantity(gathered: Candidates) -> EffortQuantity:
    return gathered.fit.dataset.effort_definition.quantity


def _standard_error(item: Evidence, coefficients: FloatArray) -> float:
    """Of a coefficient that stands alone: its evidence is the square of how many of them it is; 0 beside others."""
    alone = len(coefficients) == 1 and item.noncentrality > 0.0
    return float(abs(coefficients[0]) / np.sqrt(item.noncentrality)) if alone else 0.0
