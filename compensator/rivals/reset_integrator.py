"""The reset integrator: friction as a bond that stretches with the way, and breaks.

    p follows the way of the joint, and stays at +-p0 once it is stretched so far
    F_friction = (1 + a) Fc p / p0          |p| < p0: stuck, static friction Fs = (1 + a) Fc at the end
                 Fc sgn(p) + b w            otherwise: sliding

D. A. Haessig, B. Friedland, J. Dyn. Syst. Meas. Control 113 (1991), 354. The damping of the bond, which is there to
calm an integration, is left out: from encoder counts it would be noise.
"""

from math import copysign
from typing import NamedTuple

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.load_observer import SpeedState, follow
from compensator.rivals.rival import Knowledge, Rival, estimate


class BondState(NamedTuple):
    """Readings, and how far the bond is stretched [rad of the joint]."""

    speed: SpeedState = SpeedState()
    stretch_rad: float = 0.0


def begin(_knowledge: Knowledge) -> BondState:
    """The bond is relaxed."""
    return BondState()


def advance(knowledge: Knowledge, state: BondState, observation: Observation) -> tuple[BondState, LoadEstimate]:
    """One control cycle."""
    speed, speed_rad_s = follow(state.speed, knowledge.settings, observation.position_rad)
    most_rad, curve = knowledge.breakaway_rad, knowledge.fixed
    stretch_rad = min(max(state.stretch_rad + speed.step_rad, -most_rad), most_rad)
    if abs(stretch_rad) < most_rad:
        friction_a = curve.static_a * stretch_rad / most_rad
    else:
        friction_a = copysign(curve.coulomb_a, stretch_rad) + curve.viscous_a_s_rad * speed_rad_s * knowledge.ratio
    return BondState(speed, stretch_rad), estimate(observation, friction_a, moving=speed_rad_s != 0.0)


RIVAL = Rival("reset-integrator", "reset integrator", "Haessig, Friedland 1991", begin, advance)
