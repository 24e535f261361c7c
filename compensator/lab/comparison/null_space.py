"""What trials and channels leave open of a model, in words: what is known in combination only, and what settles it.

Three reasons: columns that are combinations of others (no trial excites them apart), coefficients that noise leaves
correlated and uncertain, and the effort's own channel, which holds more than the joint's torque.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components

from compensator.lab.effects.effect import Effect
from compensator.lab.model.fitted import Fit
from compensator.lab.model.intervals import (
    INERTIA,
    LEAST_ACCELERATION,
    ParameterEstimate,
    acceleration_over_noise,
    estimates,
)
from compensator.lab.recordings.recording import BoolArray, FloatArray

TAKES_PART = 0.1  # of a column, that another one makes
CORRELATED = 0.95  # of two coefficients: from here on it is their combination that is known
UNCERTAIN = 0.5  # of its value, that the half of a coefficient's 95 % interval is

_VOLTAGE = (
    "The effort is the {title}, which holds the back-EMF and the drop over the winding: {scale}viscous friction and "
    "the back-EMF constant are one number. A measured current settles it, or a coast-down, in which the winding is "
    "open and friction brakes alone"
)
_ESTIMATE = (
    "The current is computed from duty, supply and speed: what the back-EMF constant is off by looks like viscous "
    "friction, and what the winding's resistance is off by like a scale of all coefficients. A measured current "
    "settles it, or a coast-down for the friction and a known weight for the scale"
)
_CURRENT = {
    "rotary": (
        "The rig tells no torque constant, so that every coefficient is in A: torque constant and friction are known "
        "as their ratio only. Add motor.torque_constant_n_m_a and gear.ratio to the rig, or hang known loads"
    ),
    "linear": (
        "The effort is a current, so that every coefficient is in A: force constant and friction are known as their "
        "ratio only. Record the force (force_n)"
    ),
}


@dataclass(frozen=True)
class _Coefficient:
    """One coefficient of a fit, and where it is."""

    index: int
    effect: Effect
    name: str

    @property
    def words(self) -> str:
        return self.name if self.name.lower() in self.effect.title.lower() else f"{self.name} ({self.effect.title})"


def left_open(fit: Fit, parameters: Sequence[ParameterEstimate] | None = None) -> list[str]:
    """Sentences on what of a model is known in combination only; empty where nothing is.

    Args:
        fit: of the model.
        parameters: its estimates, where they are at hand.
    """
    known = list(_coefficients(fit))
    values = parameters if parameters is not None else estimates(fit)
    return [*_dropped(fit, known), *_in_noise(fit), *_together(fit, known, values), *_by_channel(fit)]


def _coefficients(fit: Fit) -> Iterator[_Coefficient]:
    index = 0
    for term in fit.terms:
        for parameter in term.effect.parameters:
            yield _Coefficient(index, term.effect, parameter.name)
            index += 1


def _kept(fit: Fit) -> BoolArray:
    return np.concatenate([term.kept for term in fit.terms])


def _dropped(fit: Fit, known: list[_Coefficient]) -> Iterator[str]:
    """Columns that others make up for: with each, those that take part."""
    columns, _ = fit.training_equations
    size = np.linalg.norm(columns, axis=0)
    kept = _kept(fit)
    for one in known:
        if kept[one.index] or size[one.index] == 0.0 or one.effect.provisional:
            continue
        shares = np.linalg.lstsq(columns[:, kept], columns[:, one.index], rcond=None)[0] * size[kept] / size[one.index]
        others = [known[index] for index in np.flatnonzero(kept)[np.abs(shares) > TAKES_PART]]
        names, settled_by = ", ".join(other.words for other in others), _settled_by(fit, one, others)
        yield f"{_capital(one.words)} cannot be told apart from {names} in these trials; {settled_by}"


def _settled_by(fit: Fit, one: _Coefficient, others: list[_Coefficient]) -> str:
    loads = {trial.motion.load_kg for trial in fit.dataset.trials}
    if len(loads) == 1 and all(other.effect is one.effect for other in others):
        return f"all of them hang {loads.pop():.4g} kg: trials with another load settle it"
    return f"what settles it: {one.effect.excited_by}"


def _in_noise(fit: Fit) -> Iterator[str]:
    """The inertia, where noise of the position makes most of the acceleration."""
    for effect in fit.effects:
        if effect.name == INERTIA and (ratio := acceleration_over_noise(fit)) < LEAST_ACCELERATION:
            yield (
                f"Inertia is not told by these trials: the acceleration has {ratio:.2g} times the power of noise of "
                f"the position, and {LEAST_ACCELERATION:g} times is needed; what settles it: {effect.excited_by}"
            )


def _together(fit: Fit, known: list[_Coefficient], values: Sequence[ParameterEstimate]) -> Iterator[str]:
    """Groups of coefficients of which none is known well, and whose errors go together."""
    by_name = {(value.effect, value.parameter): value for value in values}
    kept = _kept(fit)
    vague = [one for one in known if kept[one.index] and _is_uncertain(by_name.get((one.effect.name, one.name)))]
    columns, _ = fit.training_equations
    correlation = _correlation(columns[:, kept])
    place = np.cumsum(kept) - 1
    chosen = place[[one.index for one in vague]]
    bound = np.abs(correlation[np.ix_(chosen, chosen)]) > CORRELATED
    groups, label = connected_components(bound, directed=False)
    for group in range(groups):
        members = [one for one, own in zip(vague, label.tolist(), strict=True) if own == group]
        if len(members) > 1:
            names = f"{', '.join(one.words for one in members[:-1])} and {members[-1].words}"
            settled_by = "; ".join(dict.fromkeys(one.effect.excited_by for one in members[1:]))
            yield (
                f"{_capital(names)} are known in combination only: each alone is uncertain by more than "
                f"{UNCERTAIN:.0%}; what settles it: {settled_by}"
            )


def _correlation(columns: FloatArray) -> FloatArray:
    """Of the errors of the coefficients of columns (N, k), shape (k, k)."""
    size = np.linalg.norm(columns, axis=0)
    covariance = np.linalg.pinv((columns / size).T @ (columns / size))
    deviation = np.sqrt(np.diag(covariance))
    correlation: FloatArray = covariance / np.outer(deviation, deviation)
    return correlation


def _is_uncertain(value: ParameterEstimate | None) -> bool:
    """Whether an interval is wider than the value tells; a bound that cuts it off does not make it known."""
    if value is None or not np.isfinite([value.low, value.high]).all():
        return False
    return max(value.high - value.value, value.value - value.low) > UNCERTAIN * abs(value.value)


def _by_channel(fit: Fit) -> Iterator[str]:
    effort, joint = fit.dataset.effort_definition, fit.dataset.facts.joint
    if effort.quantity == "terminal_voltage":
        per_torque = _by_known_loads(fit)
        constant = "torque constant" if joint == "rotary" else "force constant"
        apart = f"{constant} and winding resistance are known as their ratio only, and " if per_torque is None else ""
        told = "" if per_torque is None else f" (1 N m is {per_torque:.3g} V, by the loads)"
        yield _VOLTAGE.format(title=effort.title, scale=apart) + told
    elif effort.quantity == "current_estimate":
        yield _ESTIMATE
    elif effort.quantity == "current" and effort.unit == "A" and _by_known_loads(fit) is None:
        yield _CURRENT[joint]


def _by_known_loads(fit: Fit) -> float | None:
    """Effort per N m that loads of different, known weight tell; None where there are none."""
    gravity = next((term for term in fit.terms if term.effect.name == "gravity"), None)
    if gravity is None or not gravity.kept[1] or gravity.coefficients[1] <= 0.0:
        return None
    return float(gravity.coefficients[1])


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]
