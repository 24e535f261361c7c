"""An effort that has little to do with the motion beside it: turned, late, or of another joint.

A rigid joint with friction explains more, whatever it lacks; but cogging of a motor that turns slowly looks so, too:
half a period later the effort seems to push, turned it seems to brake. So each of these is weighed against the effects
that may be missing: the problem of the data stands unless one of them leaves less than mending the data would.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import relative_error
from compensator.lab.model.linear import solve
from compensator.lab.model.validation import held_out

UNEXPLAINED = 0.8  # of the effort: a rigid joint with friction explains more, whatever it lacks
EXPLAINED = 0.75  # of the error: what an effect may leave of an effort that no mending of the data explains
DISSIPATIVE = ("inertia", "coulomb", "viscous")
BETTER = 0.9  # of the error: what turning the sign of the effort must bring
POOR = 0.4  # of the effort: what is left where inertia and friction would be negative, and that is no accident
SUSPECT = 0.2  # of the effort: an error from which clocks are tried
MOST_LAG_S, LAG_STEP_S = 2.0, 0.1
LEAST_LAG_S = 0.3  # less may be a delay of the chain, which is an effect of its own
MOVED = 0.6  # of the error: what moving the effort in time must leave at most


@dataclass(frozen=True)
class AlienEffort:
    """What seems to be wrong.

    Attributes:
        text: what was found and what to do.
        leaves: error, as a share of the effort, above which no effect explains it better.
        mended: the error is that of the data as they would be mended; else nothing mends them.
    """

    text: str
    leaves: float
    mended: bool


def alien_effort(fit: Fit) -> AlienEffort | None:
    """The first of: late, turned, unexplained; None where the effort is that of the motion."""
    return _late(fit) or _turned(fit) or _unexplained(fit)


def _turned(fit: Fit) -> AlienEffort | None:
    """Effort and motion of opposite signs: inertia and friction would be negative, and turned they explain more."""
    held = _held_at_zero(fit)
    if not held:
        return None
    columns, effort = fit.training_equations
    error = relative_error(effort - columns @ fit.coefficients, effort)
    turned = _error_of(fit, -effort)
    if turned >= BETTER * error:
        return None
    channels = " or ".join(fit.dataset.effort_definition.channels)
    return AlienEffort(
        f"{' and '.join(held)} would be negative: effort and motion have opposite signs (turned, the effort leaves "
        f"{turned:.0%} instead of {error:.0%}); turn the sign of {channels}, or of position",
        turned,
        mended=True,
    )


def _held_at_zero(fit: Fit) -> list[str]:
    """Inertia and friction that only their bound keeps from being negative; none where it is not both."""
    held = [
        term.effect.name
        for term in fit.terms
        if term.effect.name in DISSIPATIVE and term.kept[0] and term.at_bound[0] and term.coefficients[0] <= 0.0
    ]
    return held if "inertia" in held and len(held) > 1 else []


def _unexplained(fit: Fit) -> AlienEffort | None:
    """Inertia and friction explain next to nothing, or would be negative where much is left."""
    error = held_out(fit).relative
    if error >= UNEXPLAINED and set(DISSIPATIVE) <= set(fit.names):
        text = (
            f"inertia and friction explain next to nothing: the held-out error is {error:.0%} of the effort; check "
            "that effort and position are of the same joint and time, and their units"
        )
        return AlienEffort(text, EXPLAINED * error, mended=False)
    held, error = _held_at_zero(fit), relative_error(fit.residual[fit.training], fit.dataset.effort[fit.training])
    if error < POOR or not held:
        return None
    text = (
        f"{' and '.join(held)} would be negative, and {error:.0%} of the effort is left: effort and motion have "
        "opposite signs, or one lags far behind the other; check the sign and the time of the effort channel and of "
        "position"
    )
    return AlienEffort(text, EXPLAINED * error, mended=False)


def _late(fit: Fit) -> AlienEffort | None:
    """Effort and motion apart in time by more than any chain delays: clocks that were never laid over each other."""
    dataset, rows = fit.dataset, fit.training
    error = relative_error(fit.residual[rows], dataset.effort[rows])
    if error < SUSPECT:
        return None
    weight, errors = fit.weight[rows], {}
    for lag_s in np.arange(-MOST_LAG_S, MOST_LAG_S + 0.5 * LAG_STEP_S, LAG_STEP_S):
        moved = [np.interp(t.signals.time_s + lag_s, t.signals.time_s, t.signals.effort)[None] for t in dataset.trials]
        errors[float(lag_s)] = _error_of(fit, weight * dataset.stack(moved)[rows, 0])
    best = min(errors, key=lambda lag_s: errors[lag_s])
    turned = _error_of(fit, -weight * dataset.effort[rows])
    if abs(best) < LEAST_LAG_S or errors[best] > min(MOVED * error, turned):  # a sine that is turned seems late, too
        return None
    which = "behind" if best > 0.0 else "ahead of"
    return AlienEffort(
        f"the effort is about {abs(best):.1f} s {which} the motion (moved by that, it leaves {errors[best]:.0%} "
        f"instead of {error:.0%}); lay the clocks of {' and '.join(dataset.effort_definition.channels)} and of "
        "position over each other",
        errors[best],
        mended=True,
    )


def _error_of(fit: Fit, effort: np.ndarray) -> float:
    """What the model's columns leave of another effort (n,), weighted as the training rows are, as a share of it."""
    columns, _ = fit.training_equations
    return relative_error(effort - columns @ solve(columns, effort, fit.bounds).coefficients, effort)
