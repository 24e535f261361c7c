"""The estimator of this package, as one of the rivals."""

from compensator.motion import load_estimator
from compensator.motion.load_estimate import EstimatorState, LoadEstimate, Observation
from compensator.rivals.rival import Knowledge, Rival


def begin(knowledge: Knowledge) -> EstimatorState:
    """The lightest calibrated load is taken until a search has been made."""
    return load_estimator.begin(knowledge.model.friction.selectors[0])


def advance(
    knowledge: Knowledge, state: EstimatorState, observation: Observation
) -> tuple[EstimatorState, LoadEstimate]:
    """One control cycle."""
    return load_estimator.advance(knowledge.model, knowledge.settings, state, observation)


RIVAL = Rival(
    "online",
    "ours: one estimator at rest and in motion",
    "compensator.motion.load_estimator",
    begin,
    advance,
    searches=True,
    filters=True,
)
