"""One friction curve, whatever the load, at the measured speed; nothing at rest, where a speed tells nothing."""

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.load_observer import SpeedState, follow
from compensator.rivals.rival import Knowledge, Rival, estimate


def begin(_knowledge: Knowledge) -> SpeedState:
    """No readings yet."""
    return SpeedState()


def advance(knowledge: Knowledge, state: SpeedState, observation: Observation) -> tuple[SpeedState, LoadEstimate]:
    """One control cycle."""
    state, speed_rad_s = follow(state, knowledge.settings, observation.position_rad)
    friction_a = float(knowledge.fixed.sliding_a(speed_rad_s * knowledge.ratio))
    return state, estimate(observation, friction_a, moving=speed_rad_s != 0.0)


RIVAL = Rival("fixed", "one friction curve at the measured speed", "eq. (2) of the paper, one load", begin, advance)
