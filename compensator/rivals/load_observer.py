"""A load observer: the load that, with a friction model, explains the speed of the joint.

J dv/dt = I - F - L + 2 w0 J (v_measured - v)
  dL/dt = - w0^2 J (v_measured - v)                        both poles at w0
"""

from typing import NamedTuple

from compensator.motion.load_estimate import EstimatorSettings
from compensator.rivals.rival import BANDWIDTH_RAD_S, Knowledge

READINGS = 5


class SpeedState(NamedTuple):
    """The last readings, the oldest first."""

    positions_rad: tuple[float, ...] = ()

    @property
    def step_rad(self) -> float:
        """Way of the last cycle."""
        return self.positions_rad[-1] - self.positions_rad[-2] if len(self.positions_rad) > 1 else 0.0


def follow(state: SpeedState, settings: EstimatorSettings, position_rad: float) -> tuple[SpeedState, float]:
    """The next state, and the speed [rad/s]."""
    positions = (*state.positions_rad, position_rad)[-READINGS:]
    way_rad = positions[-1] - positions[0]
    if abs(way_rad) <= 1.5 * settings.count_rad:
        return SpeedState(positions), 0.0
    return SpeedState(positions), way_rad / ((len(positions) - 1) * settings.period_s)


class ObserverState(NamedTuple):
    """What the observer believes: speed of the joint [rad/s], load [A]."""

    speed_rad_s: float = 0.0
    load_a: float = 0.0


def observe(
    knowledge: Knowledge, state: ObserverState, measured_rad_s: float, current_a: float, friction_a: float
) -> ObserverState:
    """One control cycle, by an implicit step: stable at every period."""
    step_s, inertia, pole = knowledge.settings.period_s, knowledge.inertia_a_s2_rad, BANDWIDTH_RAD_S
    torque = (current_a - friction_a - state.load_a) / inertia
    # v' and L' of the new state, solved for v: L' = L - pole^2 J (measured - v') step
    push = torque + (2.0 * pole + pole**2 * step_s) * measured_rad_s
    speed_rad_s = (state.speed_rad_s + step_s * push) / (1.0 + step_s * (2.0 * pole + pole**2 * step_s))
    load_a = state.load_a - pole**2 * inertia * (measured_rad_s - speed_rad_s) * step_s
    return ObserverState(speed_rad_s, load_a)
