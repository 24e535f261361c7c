"""No compensation: the motor current is what is reflected."""

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.rival import Knowledge, Rival, estimate


def begin(_knowledge: Knowledge) -> None:
    """Nothing is remembered."""


def advance(_knowledge: Knowledge, state: None, observation: Observation) -> tuple[None, LoadEstimate]:
    """One control cycle."""
    return state, estimate(observation, 0.0, moving=False)


RIVAL = Rival("uncompensated", "no compensation", "the paper, Fig. 4", begin, advance)
