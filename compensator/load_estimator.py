"""The load of a joint, cycle after cycle, at rest and in motion: what a master arm can follow.

    at rest     I_load of the last zero-speed search, for as long as the motor current agrees with it: eq. (1) allows
                any load within the static friction round the present current
    stuck       speed 0 although the set point is elsewhere (a wall): friction is taken as that of motion towards the
                set point                                                                      (paper, section 3.2.1)
    in motion   I - J dw/dt - s F(w), F of the curve that the present F_load selects; then what the gear loses
    turning     just set off, turned back, or within the free play after that: held

A pure function, (state, observation) -> (state, estimate). Where one branch takes over from another, the difference
between the two dies away with `blend_s`; until then it is part of the band.
"""

from math import copysign, exp, hypot, inf, isnan, nan, sqrt

from compensator.joint_model import JointModel
from compensator.load_estimate import (
    Branch,
    EstimatorSettings,
    EstimatorState,
    LoadEstimate,
    Observation,
    RestResult,
)
from compensator.local_motion import parabola

__all__ = [
    "Branch", "EstimatorSettings", "EstimatorState", "JointModel", "LoadEstimate", "Observation", "RestResult",
    "advance", "begin",
]  # fmt: skip

BAND = 1.96  # standard deviations in half of a 95 % interval
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
    state = _remember(model, settings, _track(settings, state, observation), observation)
    branch = _branch(settings, state, observation)
    own = _own(branch, model, settings, state, observation)
    return _blend(model, settings, state, own, observation)


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
    state = state._replace(extreme_rad=position_rad, still_cycles=0)
    if way == state.direction:
        return state._replace(moving_cycles=state.moving_cycles + 1)
    return state._replace(direction=way, turned_rad=position_rad - ahead_rad, moving_cycles=1)


def _remember(
    model: JointModel, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> EstimatorState:
    state = state._replace(
        positions_rad=(*state.positions_rad, observation.position_rad)[-settings.window :],
        currents_a=(*state.currents_a, observation.current_a)[-settings.window :],
    )
    if observation.rest is not None:
        return state._replace(rest=observation.rest, selector=model.within(observation.rest.selector))
    moved = state.moving_cycles > settings.window and not observation.searching
    return state._replace(rest=None) if moved else state


def _branch(settings: EstimatorSettings, state: EstimatorState, observation: Observation) -> Branch:
    if observation.searching:
        return Branch.SEARCHING
    outside = abs(observation.target_rad - observation.position_rad) > settings.dead_band_rad
    if outside and state.still_cycles > settings.stuck_cycles:
        return Branch.STUCK
    if (not outside and state.still_cycles > settings.rest_cycles) or observation.rest is not None:
        return Branch.REST
    travel_rad = abs(state.extreme_rad - state.turned_rad)
    window_moves = state.moving_cycles > settings.window >= 2 * state.still_cycles
    return Branch.MOVING if window_moves and travel_rad > settings.free_play_rad else Branch.TURNING


def _own(
    branch: Branch, model: JointModel, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> LoadEstimate:
    """The value of the branch alone, whatever was given out before."""
    held_a = state.known_a + model.gravity_at(observation.position_rad, state.selector)
    if branch is Branch.REST:
        return _at_rest(model, state, observation, held_a)
    if branch is Branch.STUCK:
        return _stuck(model, state, observation)
    if branch is Branch.MOVING:
        return _moving(model, settings, state, observation)
    return LoadEstimate(held_a, state.estimate.half_width_a, branch)


def _at_rest(model: JointModel, state: EstimatorState, observation: Observation, held_a: float) -> LoadEstimate:
    """The search's result, or what was known before it, as far as static friction allows it."""
    margin = 1.0 + 3.0 * model.friction_scatter
    low_a, high_a = sorted(_against(model, state, observation.current_a, way, margin) for way in (1.0, -1.0))
    known_a, half_a = (held_a, inf) if state.rest is None else state.rest[:2]
    allowed_a = (low_a + high_a) / 2.0 if isnan(known_a) else min(max(known_a, low_a), high_a)
    if state.rest is None or allowed_a != known_a:
        half_a = max(high_a - allowed_a, allowed_a - low_a)
    return LoadEstimate(allowed_a, half_a, Branch.REST)


def _stuck(model: JointModel, state: EstimatorState, observation: Observation) -> LoadEstimate:
    """The push may have stopped growing anywhere in the band of static friction; the rule takes its near end."""
    way = copysign(1.0, observation.target_rad - observation.position_rad)
    near_a, far_a = (_against(model, state, observation.current_a, one, 1.0) for one in (way, -way))
    return LoadEstimate(near_a, abs(far_a - near_a), Branch.STUCK, model.friction_a(0.0, way, state.selector))


def _against(model: JointModel, state: EstimatorState, current_a: float, way: float, margin: float) -> float:
    """I_load [A] of a joint at rest that is just about to move in a direction."""
    friction_a = model.friction_a(0.0, way, state.selector)
    return model.gear_loss.load_current_a(current_a - margin * friction_a, way)


def _moving(
    model: JointModel, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> LoadEstimate:
    """Of the middle of the window, and what gravity has changed since."""
    fitted = parabola(settings.window, settings.period_s)
    motion = fitted.motion(state.positions_rad)
    rotor, arm = model.rotor_inertia_a_s2_rad, model.arm_inertia_at(state.selector)
    friction_a = model.friction_a(motion.speed_rad_s, state.direction, state.selector)
    mean_a = sum(state.currents_a) / len(state.currents_a)
    # the teeth carry the load and what accelerates the arm, but not what accelerates the rotor
    carried_a = mean_a - rotor * motion.acceleration_rad_s2 - friction_a
    load_a = model.gear_loss.load_current_a(carried_a, state.direction) - arm * motion.acceleration_rad_s2
    since_a = model.gravity_at(observation.position_rad, state.selector)
    since_a -= model.gravity_at(motion.position_rad, state.selector)
    noise_a = (rotor + arm) * fitted.acceleration_noise_rad_s2(settings.count_rad)
    spread_a = hypot(model.friction_scatter * friction_a, noise_a, sqrt(state.variance_a2))
    return LoadEstimate(load_a + since_a, BAND * spread_a, Branch.MOVING, friction_a)


def _blend(
    model: JointModel, settings: EstimatorSettings, state: EstimatorState, own: LoadEstimate, observation: Observation
) -> tuple[EstimatorState, LoadEstimate]:
    """Let the difference to what was known before die away, after a change of branch or a new result."""
    gravity_a = model.gravity_at(observation.position_rad, state.selector)
    change_a = state.known_a + gravity_a - own.load_current_a
    offset_a = state.offset_a * exp(-settings.period_s / settings.blend_s)
    if observation.rest is not None or own.branch is not state.estimate.branch:
        offset_a = 0.0 if isnan(change_a) else change_a
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
