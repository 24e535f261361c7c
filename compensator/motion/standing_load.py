"""The load of a joint that stands, has just been stopped, or has just set off: what static friction allows.

A joint at rest under a current I holds any load between the two that would just move it, eq. (1): `about_to_move_a`.
"""

from math import copysign, isnan

from compensator.motion.joint_model import JointUnderLoad
from compensator.motion.load_estimate import Branch, EstimatorSettings, EstimatorState, LoadEstimate, Observation

STOPPED_COUNTS = 4.0  # way within which a joint that strikes something stiff comes to rest, as far as counts can tell
SEEN_COUNTS = 3.0  # of motion that a current would have made, before its absence tells anything
BEFORE_CYCLES = 4  # over which the speed before a hit is taken
HIT_CYCLES = 2  # with which the motion ends, and which the hit may already have slowed down
LOOKED_BACK = HIT_CYCLES + BEFORE_CYCLES + 1


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
    near_a = about_to_move_a(joint, _stood_a(settings, state), way, 1.0)
    given = allowed(joint, settings, state, held_a, near_a, Branch.STUCK)
    return given._replace(friction_current_a=joint.friction_a(0.0, way))


def strikes(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> bool:
    """Whether a joint stands that its momentum and its current would have moved on, under the load that is known."""
    still, way = state.still_cycles, state.direction
    if still == 0 or state.moving_cycles <= still or len(state.arms) < still + LOOKED_BACK:
        return False
    if isnan(state.known_a) or _inertia(joint) == 0.0:
        return False
    # teeth that meet stop a motor, too; and an arm that nothing stops flies on from a motor that stands
    touches_rad = settings.free_play_rad / 2.0 - STOPPED_COUNTS * settings.count_rad
    carried = state.arms[-still - LOOKED_BACK : -still - HIT_CYCLES]
    if any(way * (arm.motor_rad - arm.angle_rad) < touches_rad for arm in carried):
        return False
    before_rad_s = _speed_before(settings, state)
    held_a = state.known_a + joint.gravity_at(observation.position_rad)
    slowing_a = joint.gear_loss.motor_current_a(held_a, way) + joint.friction_a(before_rad_s, way)
    slowing_a += way * 3.0 * joint.friction_scatter * abs(joint.friction_a(before_rad_s, way))
    # from the middle of the cycles that the speed is from
    since = state.currents_a[-still - HIT_CYCLES - BEFORE_CYCLES // 2 :]
    gained_rad_s = sum(current_a - slowing_a for current_a in since) * settings.period_s / _inertia(joint)
    missed_rad = way * (before_rad_s + gained_rad_s) * still * settings.period_s
    return missed_rad > SEEN_COUNTS * settings.count_rad


def _speed_before(settings: EstimatorSettings, state: EstimatorState) -> float:
    """Speed over some cycles before a hit, of which the last motion may already be part [rad/s]."""
    last = len(state.positions_rad) - 1 - state.still_cycles - HIT_CYCLES
    way_rad = state.positions_rad[last] - state.positions_rad[last - BEFORE_CYCLES]
    return way_rad / (BEFORE_CYCLES * settings.period_s)


def _inertia(joint: JointUnderLoad) -> float:
    return joint.rotor_inertia_a_s2_rad + joint.arm_inertia_a_s2_rad


def struck(joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, held_a: float) -> LoadEstimate:
    """What stops a joint of a speed v: its own current presses on, and its momentum.

        L = L_near + J v^2 / x,  no more than the middle of what friction allows, no less than what was known

    x is the way within which it stopped. Teeth and wall, once pressed, are held by friction: the current does not tell
    how far, and of a hard hit the middle errs least.
    """
    way, now_a = state.direction, state.currents_a[-1]
    near_a, far_a = (about_to_move_a(joint, now_a, one, 1.0) for one in (way, -way))
    momentum_a = _inertia(joint) * _speed_before(settings, state) ** 2 / (STOPPED_COUNTS * settings.count_rad)
    band_a = abs(far_a - near_a)
    pressed_a = near_a + way * min(momentum_a, 0.5 * band_a)
    given_a = way * max(way * pressed_a, way * held_a)
    return LoadEstimate(given_a, max(abs(given_a - near_a), abs(given_a - far_a)), Branch.STRUCK)


def leaving(joint: JointUnderLoad, state: EstimatorState, observation: Observation) -> LoadEstimate:
    """A push that is let go: what moves the joint back, which is between its weight alone and what it leant with."""
    weight_a = joint.gravity_at(observation.position_rad)
    side = copysign(1.0, state.known_a)
    pushes_a = side * (about_to_move_a(joint, state.currents_a[-1], state.direction, 1.0) - weight_a)
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
    low_a, high_a = sorted(about_to_move_a(joint, _stood_a(settings, state), way, margin) for way in (1.0, -1.0))
    if isnan(known_a):
        known_a = (low_a + high_a) / 2.0 if isnan(else_a) else else_a
    given_a = min(max(known_a, low_a), high_a)
    return LoadEstimate(given_a, max(high_a - given_a, given_a - low_a), branch)


def about_to_move_a(joint: JointUnderLoad, current_a: float, way: float, margin: float) -> float:
    """I_load [A] of a joint at rest that is just about to move in a direction."""
    return joint.gear_loss.load_current_a(current_a - margin * joint.friction_a(0.0, way), way)


def _stood_a(settings: EstimatorSettings, state: EstimatorState) -> float:
    """The newest current [A] that is known not to have moved the joint: motion shows only after a while."""
    seen = state.currents_a
    return seen[-min(settings.onset_cycles, state.still_cycles, len(seen) - 1) - 1]
