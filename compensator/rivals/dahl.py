"""Dahl's model: friction as a spring that yields, over the way of the joint.

    dF/dx = sigma (1 - sgn(v) F / Fc),  sigma = Fc / breakaway        solved exactly over the way of each cycle
    F_friction = F + b w

P. R. Dahl, "Solid friction damping of mechanical vibrations", AIAA Journal 14 (1976), 1675. No static friction.
"""

from math import copysign, exp
from typing import NamedTuple

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.load_observer import SpeedState, follow
from compensator.rivals.rival import Knowledge, Rival, estimate


class DahlState(NamedTuple):
    """Readings, and the spring's force [A]."""

    speed: SpeedState = SpeedState()
    spring_a: float = 0.0


def begin(_knowledge: Knowledge) -> DahlState:
    """The spring is relaxed."""
    return DahlState()


def advance(knowledge: Knowledge, state: DahlState, observation: Observation) -> tuple[DahlState, LoadEstimate]:
    """One control cycle."""
    speed, speed_rad_s = follow(state.speed, knowledge.settings, observation.position_rad)
    way_rad, limit_a = speed.step_rad, knowledge.fixed.coulomb_a
    end_a = copysign(limit_a, way_rad)
    spring_a = end_a + (state.spring_a - end_a) * exp(-abs(way_rad) / knowledge.breakaway_rad)
    friction_a = spring_a + knowledge.fixed.viscous_a_s_rad * speed_rad_s * knowledge.ratio
    return DahlState(speed, spring_a), estimate(observation, friction_a, moving=speed_rad_s != 0.0)


RIVAL = Rival("dahl", "Dahl's model", "Dahl 1976", begin, advance)
