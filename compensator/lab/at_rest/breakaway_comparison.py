"""What a model says of breaking away, held against the starts from rest: errors, and its parameters with intervals."""

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from compensator.lab.at_rest.breakaway_regression import BACK, LAG, BreakawayFit, fit_breakaway, held_out_breakaway
from compensator.lab.at_rest.breakaway_rows import enough_starts
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import Effect, Parameter, shape_parameters
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import HeldOut, relative_error, rms
from compensator.lab.model.intervals import CONFIDENCE, ParameterEstimate
from compensator.lab.model.linear import solve
from compensator.lab.recordings.recording import FloatArray

NOTES = {
    BACK: "of the contacts: they are still bent the way the joint came",
    LAG: "of the measurement: a start is seen a little late",
}


@dataclass(frozen=True)
class BreakawayComparison:
    """A model held against the starts from rest.

    Attributes:
        fit: of the breakaway effort.
        starts: whose effort is known; training: those that were fitted.
        relative, rms: error on the training starts, each weighted as in the fit; rms in the effort's unit.
        held_out: on starts that the coefficients have not seen.
    """

    fit: BreakawayFit
    starts: int
    training: int
    relative: float
    rms: float
    held_out: HeldOut


def compare_breakaway(fit: Fit) -> BreakawayComparison | None:
    """Hold a fitted model against its starts from rest; None where there are too few to fit anything to."""
    rows = enough_starts(fit)
    if rows is None:
        return None
    found = fit_breakaway(rows, fit.effects)
    inside = rows.training
    residual = (found.weight * found.residual)[inside]
    effort = (found.weight * rows.effort)[inside]
    return BreakawayComparison(
        found, len(rows), int(inside.sum()), relative_error(residual, effort), rms(residual), held_out_breakaway(found)
    )


def held_out_both(before: Fit, after: Fit) -> tuple[HeldOut, HeldOut] | None:
    """Held-out error of two models of the same trials on their starts, under the weights of the first."""
    rows = enough_starts(before)
    if rows is None:
        return None
    one, other = (fit_breakaway(rows, fit.effects) for fit in (before, after))
    return held_out_breakaway(one), held_out_breakaway(other, one.weight)


def breakaway_estimates(fit: BreakawayFit) -> list[ParameterEstimate]:
    """Every coefficient and shape value of the breakaway effort, in order; intervals by leaving out whole units."""
    facts = fit.rows.fit.dataset.facts
    unit = fit.rows.fit.dataset.effort_definition.unit
    half = _half_widths(fit)
    found, index = [], 0
    for share in fit.shares:
        effect = catalogue().get(share.name)
        for value, kept, parameter in zip(share.coefficients, share.kept, share.parameters, strict=True):
            width = float(half[index])
            found.append(
                ParameterEstimate(
                    effect=share.name,
                    parameter=parameter.name,
                    unit=parameter.unit_in(unit, facts.position_unit),
                    value=float(value) if kept else float("nan"),
                    low=max(float(value) - width, parameter.low) if kept else float("nan"),
                    high=min(float(value) + width, parameter.high) if kept else float("nan"),
                    note=_note(share.name, bool(kept)),
                )
            )
            index += 1
        for one, number in zip(_shape_parameters(effect), share.shape, strict=False):
            shown = one.unit_in(unit, facts.position_unit)
            found.append(ParameterEstimate(share.name, one.name, shown, number, float("nan"), float("nan"), ""))
    return found


def _shape_parameters(effect: Effect | None) -> list[Parameter]:
    share = None if effect is None else effect.breakaway
    return [] if share is None else shape_parameters(share.shape_names, share.shape_units)


def _note(name: str, kept: bool) -> str:
    if not kept:
        return "these starts cannot tell it apart from the parameters before it"
    return NOTES.get(name, "")


def _half_widths(fit: BreakawayFit) -> FloatArray:
    """Half widths of the intervals of all coefficients, shape (K,), by a delete-one jackknife over units."""
    rows = fit.rows
    inside = rows.training
    columns = fit.weight[inside, None] * fit.columns[inside]
    effort, unit = (fit.weight * rows.free)[inside], rows.unit[inside]
    without = [solve(columns[unit != one], effort[unit != one], fit.bounds).coefficients for one in np.unique(unit)]
    count = len(without)
    if count <= 2:
        return np.full(columns.shape[1], np.nan)
    spread = np.array(without) - np.mean(without, axis=0)
    error = np.sqrt((count - 1.0) / count * np.sum(spread**2, axis=0))
    half: FloatArray = error * stdtrit(count - 1, 0.5 + 0.5 * CONFIDENCE)
    return half
