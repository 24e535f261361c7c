"""A load observer with the LuGre model: bristles that bend with the way and slip at what eq. (2) allows.

    dz/dt = v - sigma0 |v| z / g(v),  g(v) = Fc + (Fs - Fc) exp(-|v/vs|^ds)      solved exactly over the way of a cycle
    F_friction = sigma0 z + b w,  sigma0 = Fs / breakaway

C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, IEEE Trans. Autom. Control 40 (1995), 419. Its bristle
damping sigma1 is left out: from encoder counts it would be noise. The observer corrects the load, not the bristles:
motor-side measurement cannot tell the two apart.
"""

from math import copysign, exp
from typing import NamedTuple

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.load_observer import ObserverState, SpeedState, follow, observe
from compensator.rivals.rival import Knowledge, Rival, estimate


class State(NamedTuple):
    """Readings, bristles [A, sigma0 z], observer."""

    speed: SpeedState = SpeedState()
    bristles_a: float = 0.0
    observer: ObserverState = ObserverState()


def begin(_knowledge: Knowledge) -> State:
    """At rest, bristles straight, without a load."""
    return State()


def advance(knowledge: Knowledge, state: State, observation: Observation) -> tuple[State, LoadEstimate]:
    """One control cycle."""
    speed, speed_rad_s = follow(state.speed, knowledge.settings, observation.position_rad)
    curve, way_rad, motor_rad_s = knowledge.fixed, speed.step_rad, speed_rad_s * knowledge.ratio
    viscous_a = curve.viscous_a_s_rad * motor_rad_s
    slipping_a = abs(float(curve.sliding_a(motor_rad_s))) - abs(viscous_a) if motor_rad_s else curve.static_a
    end_a = copysign(slipping_a, way_rad)
    bent = exp(-abs(way_rad) * curve.static_a / (knowledge.breakaway_rad * slipping_a))
    bristles_a = end_a + (state.bristles_a - end_a) * bent
    friction_a = bristles_a + viscous_a
    observer = observe(knowledge, state.observer, speed_rad_s, observation.current_a, friction_a)
    found = estimate(observation, friction_a, moving=speed_rad_s != 0.0)
    return State(speed, bristles_a, observer), found._replace(load_current_a=observer.load_a)


RIVAL = Rival("lugre-observer", "LuGre observer", "Canudas de Wit et al. 1995", begin, advance, filters=True)
