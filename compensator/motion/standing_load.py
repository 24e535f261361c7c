"""The load of a joint that stands, or has just set off: what static friction allows.

A joint at rest under a current I holds any load between the two that would just move it, eq. (1): `about_to_move_a`.
"""

from math import copysign, isnan

from compensator.motion.joint_model import JointUnderLoad
from compensator.motion.load_estimate import Branch, EstimatorSettings, EstimatorState, LoadEstimate, Observation

CREEP_COUNTS = 3.0  # of way, twice as long as a current takes to show


def at_rest(joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, held_a: float) -> LoadEstimate:
    """The search's result, or what was known before it, as far as static friction allows it."""
    if state.rest is None:
        return allowed(joint, settings, state, held_a, held_a, Branch.REST)
    known_a, half_a, _ = state.rest
    given = allowed(joint, settings, state, known_a, known_a, Branch.REST)
    return given._replace(half_width_a=half_a) if given.load_current_a == known_a else given


def stuck(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation, held_a: float
) -> LoadEstimate:
    """The near end of the band of static friction, as for motion towards the set point: a push that grows lies there.

    What was known before stands for as long as the band holds it: then friction alone may be what holds the joint.
    """
    way = copysign(1.0, observation.target_rad - observation.position_rad)
    near_a = joint.about_to_move_a(_stood_a(settings, state), way)
    given = allowed(joint, settings, state, held_a, near_a, Branch.STUCK)
    return given._replace(friction_current_a=joint.friction_a(0.0, way))


def leaving(joint: JointUnderLoad, state: EstimatorState, observation: Observation) -> LoadEstimate:
    """A push that is let go: what moves the joint back, which is between its weight alone and what it leant with."""
    weight_a = joint.gravity_at(observation.position_rad)
    side = copysign(1.0, state.known_a)
    pushes_a = side * (joint.about_to_move_a(state.currents_a[-1], state.direction) - weight_a)
    given_a = weight_a + side * min(max(pushes_a, 0.0), abs(state.known_a))
    return LoadEstimate(given_a, state.estimate.half_width_a, Branch.LEAVING)


def allowed(
    joint: JointUnderLoad,
    settings: EstimatorSettings,
    state: EstimatorState,
    known_a: float,
    else_a: float,
    branch: Branch,
) -> LoadEstimate:
    """What is known, as far as static friction allows it: eq. (1); something else, or the middle, where nothing is."""
    margin = 1.0 + 3.0 * joint.friction_scatter
    low_a, high_a = sorted(joint.about_to_move_a(_stood_a(settings, state), way, margin) for way in (1.0, -1.0))
    if isnan(known_a):
        known_a = (low_a + high_a) / 2.0 if isnan(else_a) else else_a
    given_a = min(max(known_a, low_a), high_a)
    return LoadEstimate(given_a, max(high_a - given_a, given_a - low_a), branch)


def creeps(settings: EstimatorSettings, state: EstimatorState) -> bool:
    """Whether a joint hardly moves, or stands: what accelerates it is too little to count."""
    seen = state.positions_rad[-2 * settings.onset_cycles :]
    return len(seen) == 2 * settings.onset_cycles and max(seen) - min(seen) <= CREEP_COUNTS * settings.count_rad


def _stood_a(settings: EstimatorSettings, state: EstimatorState) -> float:
    """The newest current [A] that is known not to have moved the joint: motion shows only after a while."""
    seen, shows = state.currents_a, settings.onset_cycles
    return seen[-min(shows if creeps(settings, state) else min(shows, state.still_cycles), len(seen) - 1) - 1]
