"""The paper's scheme (section 3.2): zero and non-zero speed apart.

    at rest     I_load of the last zero-speed search, eqs (9), (10)
    in motion   I - F(w) of the curve that the last F_load selects
    stuck       speed 0 for long, away from the set point: as in motion towards it
Between these the last estimate is held. No inertia: accelerated motion is the paper's future work.
"""

from math import copysign, nan
from typing import NamedTuple

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.load_observer import SpeedState, follow
from compensator.rivals.rival import Knowledge, Rival, estimate

CREEP_RAD_S = 1e-6  # of the motor: the curve's value next to speed 0


class State(NamedTuple):
    """Readings, cycles at rest, F_load [A], and the last estimate."""

    speed: SpeedState
    still_cycles: int
    f_load_a: float
    held: LoadEstimate | None = None


def begin(knowledge: Knowledge) -> State:
    """The lightest calibrated load is taken until a search has been made."""
    return State(SpeedState(), 0, knowledge.lookup.selectors[0])


def advance(knowledge: Knowledge, state: State, observation: Observation) -> tuple[State, LoadEstimate]:
    """One control cycle."""
    speed, speed_rad_s = follow(state.speed, knowledge.settings, observation.position_rad)
    state = state._replace(speed=speed, still_cycles=state.still_cycles + 1 if speed_rad_s == 0.0 else 0)
    if observation.rest is not None:
        low_a, high_a = knowledge.lookup.allowed()
        state = state._replace(f_load_a=min(max(observation.rest.selector, low_a), high_a))
    found = _estimate(knowledge, state, observation, speed_rad_s)
    return state._replace(held=found), found


def _estimate(knowledge: Knowledge, state: State, observation: Observation, speed_rad_s: float) -> LoadEstimate:
    if observation.rest is not None:
        friction_a = observation.current_a - observation.rest.load_current_a
        return estimate(observation, friction_a, moving=False)
    away_rad = observation.target_rad - observation.position_rad
    stuck = abs(away_rad) > knowledge.settings.dead_band_rad and state.still_cycles > knowledge.settings.stuck_cycles
    if not observation.searching and (speed_rad_s != 0.0 or stuck):
        motor_rad_s = speed_rad_s * knowledge.ratio if speed_rad_s else copysign(CREEP_RAD_S, away_rad)
        return estimate(observation, float(knowledge.lookup.current_a(motor_rad_s, state.f_load_a)), moving=True)
    return state.held or estimate(observation, 0.0, moving=False)._replace(load_current_a=nan)


RIVAL = Rival("paper", "the paper's scheme", "Saini, Sarkar, Datta Ray 2013", begin, advance, searches=True)
