"""The load of a joint, cycle after cycle, at rest and in motion: what a master arm can follow.

    at rest     I_load of the last zero-speed search, or what was known before, for as long as the motor current agrees
                with it: eq. (1) allows any load within the static friction round the present current
    stuck       speed 0 although the set point is elsewhere (a wall): the same; as the push grows, what is known is
                pressed to the end of that band at which friction is that of motion towards the set point, and this is
                the rule                                                                       (paper, section 3.2.1)
    in motion   I - J dw/dt - s F(w), F of the curve that the present F_load selects; then what the gear loses
    struck      stopped at once, under a current that would move it: what its momentum wedged, see `hit`
    leaving     moving back from what it was stuck against: as in motion, between the weight and what it leant with,
                since a wall cannot pull
    turning     just set off, turned back, or within the free play after that: held, as static friction allows it while
                the joint stands

A pure function, (state, observation) -> (state, estimate). Where one branch takes over from another, the difference
between the two dies away with `blend_s`; until then it is part of the band.
"""

from math import copysign, exp, inf, isnan, nan

from compensator.motion import free_play, hit, standing_load
from compensator.motion.joint_model import JointModel, JointUnderLoad
from compensator.motion.load_estimate import (
    Branch,
    EstimatorSettings,
    EstimatorState,
    LoadEstimate,
    Observation,
    RestResult,
)
from compensator.motion.moving_load import moving_load

__all__ = [
    "Branch", "EstimatorSettings", "EstimatorState", "JointModel", "LoadEstimate", "Observation", "RestResult",
    "advance", "begin",
]  # fmt: skip

MISSED_CYCLES = 3  # without motion, before the joint may be standing
UNEXPLAINED = 0.25  # of what the weight takes at 90 degrees: with more, the arm leans on something
SUDDEN = (Branch.STRUCK, Branch.LEAVING)
SPREAD_WINDOWS = 4.0  # over which the scatter in motion is observed


def begin(selector: float) -> EstimatorState:
    """Nothing is known yet but a first guess of what selects the friction curve, such as the lightest calibrated."""
    return EstimatorState(selector)


def advance(
    model: JointModel, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> tuple[EstimatorState, LoadEstimate]:
    """One control cycle."""
    if isnan(observation.position_rad) or isnan(observation.current_a):
        return _lose(state)
    joint, state = _joint(model, state, observation)
    state = _remember(joint, settings, _track(settings, state, observation), observation)
    state = state._replace(hit=hit.struck(joint, settings, state, observation))
    branch = _branch(joint, settings, state, observation)
    leans = branch in (Branch.STUCK, Branch.STRUCK)
    state = state._replace(leant=leans or (state.leant and branch is not Branch.MOVING))
    own = _own(branch, joint, settings, state, observation)
    return _blend(joint, settings, state, own, observation)


def _joint(model: JointModel, state: EstimatorState, observation: Observation) -> tuple[JointUnderLoad, EstimatorState]:
    """The model under what the last search found to hang there."""
    selector = state.selector if observation.rest is None else model.within(observation.rest.selector)
    if state.joint is not None and selector == state.selector:
        return state.joint, state
    joint = model.under(selector)
    return joint, state._replace(selector=selector, joint=joint)


def _lose(state: EstimatorState) -> tuple[EstimatorState, LoadEstimate]:
    lost = LoadEstimate(nan, inf, Branch.LOST)
    forgotten = EstimatorState(state.selector)
    return forgotten._replace(estimate=lost), lost


def _track(settings: EstimatorSettings, state: EstimatorState, observation: Observation) -> EstimatorState:
    """Which way the joint goes, since when, and since when it stands. One count of jitter is no motion."""
    position_rad, jitter_rad = observation.position_rad, 1.5 * settings.count_rad
    if isnan(state.extreme_rad):
        return state._replace(extreme_rad=position_rad)
    ahead_rad = position_rad - state.extreme_rad
    if abs(ahead_rad) <= jitter_rad and not state.direction * ahead_rad > 0.0:
        still = state.still_cycles + 1
        moving = 0 if still > settings.rest_cycles else state.moving_cycles + 1
        return state._replace(still_cycles=still, moving_cycles=moving)
    way = copysign(1.0, ahead_rad)
    if way == state.direction:
        return state._replace(extreme_rad=position_rad, still_cycles=0, moving_cycles=state.moving_cycles + 1)
    came_rad = abs(state.extreme_rad - state.turned_rad) if state.direction else 0.0
    state = state._replace(extreme_rad=position_rad, still_cycles=0)
    return state._replace(direction=way, turned_rad=position_rad - ahead_rad, came_rad=came_rad, moving_cycles=1)


def _remember(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> EstimatorState:
    moved = state.moving_cycles > settings.window and not observation.searching
    position_rad, play_rad = observation.position_rad, settings.free_play_rad
    more_a = 0.0 if isnan(state.known_a) or _explained(joint, state) else state.known_a
    if state.arms:
        arm = free_play.follow(joint, state.arms[-1], position_rad, more_a, play_rad, settings.period_s)
    else:
        arm = free_play.begin(position_rad, joint.gravity_at(position_rad) + more_a, play_rad)
    return state._replace(
        positions_rad=(*state.positions_rad, position_rad)[-settings.window :],
        currents_a=(*state.currents_a, observation.current_a)[-settings.window :],
        arms=(*state.arms, arm)[-settings.window :],
        mores_a=(*state.mores_a, more_a)[-settings.window :],
        rest=observation.rest or (None if moved else state.rest),
    )


def _explained(joint: JointUnderLoad, state: EstimatorState) -> bool:
    """Whether the weight on the arm is nearly all of its load."""
    return joint.gravity_a > 0.0 and not abs(state.known_a) > UNEXPLAINED * joint.gravity_a


def _branch(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> Branch:
    if observation.searching:
        return Branch.SEARCHING
    outside = abs(observation.target_rad - observation.position_rad) > settings.dead_band_rad
    if outside and state.still_cycles > settings.stuck_cycles:
        return Branch.STUCK
    if (not outside and state.still_cycles > settings.rest_cycles) or observation.rest is not None:
        return Branch.REST
    travel_rad = abs(state.extreme_rad - state.turned_rad)
    # what follows the last motion may be at rest already, held by any friction
    window_moves = state.moving_cycles > settings.window and state.still_cycles <= MISSED_CYCLES
    if state.hit is not None:
        return Branch.STRUCK
    if not window_moves or travel_rad <= settings.free_play_rad:
        return Branch.LEAVING if _leaves(joint, settings, state) else Branch.TURNING
    return Branch.MOVING


def _leaves(joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState) -> bool:
    """Whether the joint moves away from what it leant on: that can only push it on, and less and less."""
    moves = state.still_cycles <= settings.onset_cycles
    pushed = not _explained(joint, state) or state.estimate.branch is Branch.LEAVING
    return moves and state.leant and pushed and state.direction * state.known_a < 0.0


def _own(
    branch: Branch, joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> LoadEstimate:
    """The value of the branch alone, whatever was given out before."""
    held_a = state.known_a + joint.gravity_at(observation.position_rad)
    if branch is Branch.REST:
        return standing_load.at_rest(joint, settings, state, held_a)
    if branch is Branch.STUCK:
        return standing_load.stuck(joint, settings, state, observation, held_a)
    if state.hit is not None and branch is Branch.STRUCK:
        return hit.estimate(joint, state, state.hit, held_a)
    if branch is Branch.MOVING:
        return moving_load(joint, settings, state, observation)
    if branch is Branch.LEAVING:
        return standing_load.leaving(joint, state, observation)
    stands = state.still_cycles > settings.onset_cycles or standing_load.creeps(settings, state)
    if branch is Branch.TURNING and stands and not isnan(held_a):
        return standing_load.allowed(joint, settings, state, held_a, nan, branch)
    return LoadEstimate(held_a, state.estimate.half_width_a, branch)


def _blend(
    joint: JointUnderLoad,
    settings: EstimatorSettings,
    state: EstimatorState,
    own: LoadEstimate,
    observation: Observation,
) -> tuple[EstimatorState, LoadEstimate]:
    """Let the difference to what was known before die away, after a change of branch or a new result."""
    gravity_a = joint.gravity_at(observation.position_rad)
    change_a = state.known_a + gravity_a - own.load_current_a
    offset_a = state.offset_a * exp(-settings.period_s / settings.blend_s)
    if observation.rest is not None or own.branch is not state.estimate.branch:
        # a hit, and a push that is let go, are as sudden as they look
        offset_a = 0.0 if isnan(change_a) or own.branch in SUDDEN else change_a
    given = own._replace(load_current_a=own.load_current_a + offset_a, half_width_a=own.half_width_a + abs(offset_a))
    state = state._replace(estimate=given, known_a=given.load_current_a - gravity_a, offset_a=offset_a)
    return _spread(settings, state, own.load_current_a - gravity_a), given


def _spread(settings: EstimatorSettings, state: EstimatorState, own_a: float) -> EstimatorState:
    """How far the branch in motion scatters: free play lets arm and motor rattle, and the encoder sees the motor."""
    if state.estimate.branch is not Branch.MOVING:
        return state
    if isnan(state.mean_a):
        return state._replace(mean_a=own_a)
    share = 1.0 / (SPREAD_WINDOWS * settings.window)
    deviation_a = own_a - state.mean_a
    mean_a = state.mean_a + share * deviation_a
    return state._replace(mean_a=mean_a, variance_a2=(1.0 - share) * (state.variance_a2 + share * deviation_a**2))
