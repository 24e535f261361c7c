"""The position that a fitted model predicts under the servo's own control law: all trials side by side.

Friction is set-valued and implicit: it holds a joint that it can hold. All in the study's effort, a terminal voltage.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.model.fitted import Fit
from compensator.lab.model.prediction import effort_per_torque
from compensator.lab.recordings.recording import FloatArray


@dataclass(frozen=True)
class Logs:
    """T trials of one load on one time grid.

    Attributes:
        target, measured: positions [rad], shape (n, T).
        gain: volts per radian of position error, shape (T,).
        most_v: of the supply.
        step_s: of the grid.
    """

    target: FloatArray
    measured: FloatArray
    gain: FloatArray
    most_v: float
    step_s: float

    def mean_absolute_error_rad(self, simulated: FloatArray) -> float:
        """Mean over all samples of all trials."""
        return float(np.mean(np.abs(simulated - self.measured)))


def simulated(fit: Fit, logs: Logs) -> FloatArray:
    """Positions from the measured start on, shape (n, T)."""
    effort_of = _effort_law(fit)
    position, velocity = logs.measured[0].copy(), np.zeros(logs.measured.shape[1])
    acceleration = np.zeros_like(velocity)
    found = np.empty_like(logs.measured)
    for index, target in enumerate(logs.target):
        found[index] = position
        effort = np.clip(logs.gain * (target - position), -logs.most_v, logs.most_v)
        ahead, back = (effort_of(position, velocity, 0.0, way, acceleration) for way in (1.0, -1.0))
        inertia = effort_of(position, velocity, 1.0, 1.0, acceleration) - ahead
        dry = np.maximum(0.5 * (ahead - back), 0.0)
        free = velocity + logs.step_s * (effort - 0.5 * (ahead + back)) / inertia
        after = np.sign(free) * np.maximum(np.abs(free) - logs.step_s * dry / inertia, 0.0)
        acceleration = (after - velocity) / logs.step_s
        velocity = after
        position = position + logs.step_s * velocity
    return found


def _effort_law(fit: Fit) -> Callable[..., FloatArray]:
    """Effort at a position, velocity, acceleration and direction, given the acceleration that the load has."""
    pattern = fit.dataset.trials[0].motion
    beyond = (effort_per_torque(fit.dataset, fit.terms) or 0.0) * pattern.load_inertia_kg_m2

    def effort_of(
        position: FloatArray, velocity: FloatArray, acceleration: float, way: float, of_load: FloatArray
    ) -> FloatArray:
        same = np.ones_like(position)
        moment = replace(
            pattern, time_s=0.0 * same, position=position, velocity=velocity, acceleration=acceleration * same,
            jerk=0.0 * same, direction=way * same, load_effort=0.0 * same, predicted=0.0 * same,
            effort_rate=0.0 * same, temperature_c=np.nan * same, supply_v=np.nan * same,
        )  # fmt: skip
        load = beyond * of_load + _sum(fit, moment, carried=True)
        return _sum(fit, replace(moment, load_effort=load), carried=False)

    return effort_of


def _sum(fit: Fit, motion: Motion, carried: bool) -> FloatArray:
    terms = [term for term in fit.terms if term.effect.carried or not carried]
    return np.sum([term.coefficients @ term.effect.columns(motion, term.shape) for term in terms], axis=0)
