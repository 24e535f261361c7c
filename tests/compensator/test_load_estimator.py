"""One estimate of the load at rest, stuck, turning and in motion."""

from dataclasses import replace
from itertools import pairwise
from math import cos, inf, isnan, nan, pi, sin

import pytest

from compensator.errors import ModelParameterError
from compensator.motion import load_estimator
from compensator.motion.friction_lookup import FrictionLookup
from compensator.motion.gear_loss import GearLoss
from compensator.motion.kinetic_friction import KineticFriction
from compensator.motion.load_estimator import Branch, EstimatorSettings, JointModel, Observation, RestResult

PERIOD_S, COUNT_RAD = 0.005, 1e-5
LIGHT, HEAVY = KineticFriction(0.06, 0.1, 5.0, 2.0, 2e-3), KineticFriction(0.16, 0.27, 5.0, 2.0, 2e-3)
MODEL = JointModel(
    FrictionLookup.over_friction({0.1: LIGHT, 0.27: HEAVY}),
    ratio=20.0,
    rotor_inertia_a_s2_rad=0.012,
    arm_inertia_a_s2_rad=(0.01, 0.035),
    gear_loss=GearLoss(0.25, 0.2, 0.003),
)
SETTINGS = EstimatorSettings(PERIOD_S, COUNT_RAD, free_play_rad=0.01, dead_band_rad=0.004)


def follow(observations, model=MODEL, settings=SETTINGS, selector=0.1):
    """The estimate of every observation."""
    state, found = load_estimator.begin(selector), []
    for observation in observations:
        state, estimate = load_estimator.advance(model, settings, state, observation)
        found.append(estimate)
    return found


def counted(position_rad):
    return round(position_rad / COUNT_RAD) * COUNT_RAD


def motor_current_a(load_a, speed, acceleration, selector=0.1, model=MODEL):
    """What the motor of exactly this model takes in motion."""
    way, joint = (1.0 if speed > 0 else -1.0), model.under(selector)
    teeth_a = load_a + joint.arm_inertia_a_s2_rad * acceleration
    rotor_a = joint.rotor_inertia_a_s2_rad * acceleration
    return joint.gear_loss.motor_current_a(teeth_a, way) + rotor_a + joint.friction_a(speed, way)


def cruise(load_a, speed, seconds=0.6, start_rad=0.0, selector=0.1):
    cycles = range(round(seconds / PERIOD_S))
    current_a = motor_current_a(load_a, speed, 0.0, selector)
    return [Observation(counted(start_rad + speed * cycle * PERIOD_S), current_a) for cycle in cycles]


def stand(current_a, cycles=60, position_rad=0.0, target_rad=0.0, **more):
    return [Observation(position_rad, current_a, target_rad, **more)] * cycles


@pytest.mark.parametrize("load_a", [-0.3, 0.0, 0.3])
@pytest.mark.parametrize("speed", [-5.0, -0.5, 0.5, 5.0])
def test_at_a_steady_speed_the_load_is_found(load_a, speed):
    last = follow(cruise(load_a, speed))[-1]
    assert last.branch is Branch.MOVING
    assert last.load_current_a == pytest.approx(load_a, abs=2e-3)


def test_the_curve_is_that_of_the_present_f_load():
    found = RestResult(0.3, 0.005, 0.27)
    moves = cruise(0.3, 2.0, selector=0.27)
    wrong = follow(moves)[-1]
    right = follow([*stand(0.3, rest=found), *moves])[-1]
    assert right.load_current_a == pytest.approx(0.3, abs=2e-3)
    assert abs(wrong.load_current_a - 0.3) > 0.05


def test_what_accelerates_rotor_and_arm_is_no_load():
    # half a turn back and forth: speed never 0 in the window that is looked at
    seen = []
    for cycle in range(80):
        time_s = cycle * PERIOD_S
        speed, acceleration = 1.0 + 8.0 * time_s, 8.0
        position_rad = time_s + 4.0 * time_s**2
        seen.append(Observation(counted(position_rad), motor_current_a(0.2, speed, acceleration)))
    assert follow(seen)[-1].load_current_a == pytest.approx(0.2, abs=4e-3)
    rigid = replace(MODEL, rotor_inertia_a_s2_rad=0.0, arm_inertia_a_s2_rad=(0.0, 0.0))
    assert abs(follow(seen, rigid)[-1].load_current_a - 0.2) > 0.1


def test_gravity_by_the_model_makes_up_for_the_age_of_the_estimate():
    weigh = replace(MODEL, gravity_a=(0.3, 0.3))
    seen = []
    for cycle in range(200):
        time_s = cycle * PERIOD_S
        angle_rad = 2.0 * time_s - 1.0
        seen.append(Observation(counted(angle_rad), motor_current_a(0.3 * sin(angle_rad), 2.0, 0.0)))
    truth_a = 0.3 * sin(seen[-1].position_rad)
    assert follow(seen, weigh)[-1].load_current_a == pytest.approx(truth_a, abs=3e-3)
    late_a = follow(seen)[-1].load_current_a - truth_a
    assert late_a == pytest.approx(-0.3 * cos(seen[-1].position_rad) * 2.0 * SETTINGS.latency_s, rel=0.3)


def test_a_push_is_dropped_as_the_joint_moves_back_from_what_it_leant_on():
    weigh = replace(MODEL, gravity_a=(0.1, 0.1))
    pressed = [Observation(0.5, 0.9, target_rad=0.6)] * 200
    back = [Observation(counted(0.5 - 0.3 * cycle * PERIOD_S), -0.1, target_rad=0.3) for cycle in range(1, 30)]
    known = Observation(0.5, 0.2, target_rad=0.5, rest=RestResult(0.1 * sin(0.5), 0.005, 0.1))
    estimates = follow([*stand(0.2, 40, 0.5, 0.5), known, *pressed, *back], weigh)
    assert estimates[240].branch is Branch.STUCK
    assert estimates[240].load_current_a > 0.5
    assert Branch.LEAVING in {one.branch for one in estimates[241:]}
    # long before a window of motion has been seen: that takes 40 cycles
    assert estimates[-1].load_current_a < 0.2
    assert all(abs(after.load_current_a - before.load_current_a) < 0.05 for before, after in pairwise(estimates[241:]))


def test_dry_friction_that_is_unequal_both_ways_is_more_so_towards_rest():
    joint = replace(MODEL, offsets_a=(0.02, 0.02), rise_offsets_a=(0.01, 0.01)).under(0.1)
    slow, quick = (joint.friction_a(speed, 1.0) + joint.friction_a(speed, -1.0) for speed in (0.0, 5.0))
    assert slow == pytest.approx(2.0 * 0.03)
    assert quick == pytest.approx(2.0 * 0.02)


def test_at_rest_the_result_of_the_search_stands():
    estimates = follow([*stand(0.35), *stand(0.35, 1, rest=RestResult(0.3, 0.005, 0.1)), *stand(0.35, 400)])
    assert estimates[-1].branch is Branch.REST
    assert estimates[-1].load_current_a == pytest.approx(0.3, abs=1e-6)
    assert estimates[-1].half_width_a == pytest.approx(0.005, abs=1e-6)


def test_without_a_search_static_friction_bounds_the_load():
    last = follow(stand(0.3))[-1]
    low_a = (0.3 - 1.09 * 0.1) / 1.25
    high_a = (0.3 + 1.09 * 0.1 - 0.003) / 0.8
    assert last.load_current_a - last.half_width_a == pytest.approx(low_a, rel=1e-6)
    assert last.load_current_a + last.half_width_a == pytest.approx(high_a, rel=1e-6)


def test_a_result_that_the_current_contradicts_gives_way():
    # somebody leans on the arm: the servo holds with 0.6 A more than the load found
    estimates = follow([*stand(0.3, 1, rest=RestResult(0.3, 0.005, 0.1)), *stand(0.9, 400)])
    assert estimates[-1].load_current_a == pytest.approx((0.9 - 1.09 * 0.1) / 1.25, abs=1e-4)
    assert estimates[-1].half_width_a > 0.05


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_stuck_against_a_wall_friction_points_away_from_the_set_point(way):
    last = follow(stand(way * 0.6, 400, target_rad=way * 0.1))[-1]
    assert last.branch is Branch.STUCK
    assert last.load_current_a == pytest.approx(way * (0.6 - 0.1) / 1.25, abs=1e-4)
    assert last.friction_current_a == pytest.approx(way * 0.1, rel=1e-6)


def test_after_turning_back_the_estimate_is_held_through_the_free_play():
    there, at_rad, speed = cruise(0.3, 0.5), 0.3, 0.5
    # slowed down by the motor: what stops at once has struck something
    while speed > 0.0:
        there.append(Observation(counted(at_rad), motor_current_a(0.3, speed, -5.0)))
        at_rad += speed * PERIOD_S
        speed -= 5.0 * PERIOD_S
    top_rad = there[-1].position_rad
    # within the gap the motor turns against its own friction alone
    gap = [Observation(counted(top_rad - 0.0001 * cycle), -0.07) for cycle in range(1, 99)]
    estimates = follow([*there, *gap])
    assert {estimate.branch for estimate in estimates[len(there) + 2 :]} == {Branch.TURNING}
    # as it was while the motor slowed it down
    turned_a = estimates[len(there) - 1].load_current_a
    assert turned_a == pytest.approx(0.3, abs=6e-3)
    assert estimates[-1].load_current_a == pytest.approx(turned_a, abs=2e-3)


def test_no_jump_where_one_branch_takes_over_from_another():
    # the search's result and the motion after it disagree by 40 mA; counts make 2 mA of noise
    seen = [*stand(0.35, 1, rest=RestResult(0.34, 0.005, 0.1)), *stand(0.35, 100), *cruise(0.3, 2.0, 1.5)]
    loads_a = [estimate.load_current_a for estimate in follow(seen)]
    steps_a = [abs(after - before) for before, after in pairwise(loads_a)]
    assert max(steps_a) <= 0.04 * PERIOD_S / SETTINGS.blend_s + 5e-4
    assert loads_a[-1] == pytest.approx(0.3, abs=2e-3)


def test_the_band_holds_the_difference_while_it_dies_away():
    seen = [*stand(0.35, 1, rest=RestResult(0.34, 0.005, 0.1)), *stand(0.35, 100), *cruise(0.3, 2.0, 1.0)]
    for estimate in follow(seen)[150:]:
        if estimate.branch is Branch.MOVING:
            assert abs(estimate.load_current_a - 0.3) <= estimate.half_width_a


def test_while_a_search_moves_the_joint_the_estimate_is_held():
    ramp = [Observation(1e-4 * cycle, 0.3 + 0.01 * cycle, 0.0, searching=True) for cycle in range(50)]
    estimates = follow([*stand(0.35, 1, rest=RestResult(0.3, 0.005, 0.1)), *stand(0.35), *ramp])
    assert estimates[-1].branch is Branch.SEARCHING
    assert estimates[-1].load_current_a == pytest.approx(0.3, abs=1e-6)


@pytest.mark.parametrize("lost", [Observation(nan, 0.3), Observation(0.0, nan)])
def test_a_lost_sample_gives_no_number(lost):
    estimates = follow([*stand(0.3), lost, *stand(0.3)])
    assert isnan(estimates[60].load_current_a)
    assert estimates[60].half_width_a == inf
    assert estimates[60].branch is Branch.LOST
    assert estimates[-1].branch is Branch.REST


def test_until_something_is_known_there_is_no_number():
    assert isnan(follow(cruise(0.3, 2.0, 0.1))[-1].load_current_a)


def test_a_selector_outside_of_the_calibrated_ones_takes_the_nearest_allowed():
    found = follow([*stand(0.3, 1, rest=RestResult(0.3, 0.005, 9.0)), *cruise(0.3, 2.0, selector=0.287)])
    assert found[-1].load_current_a == pytest.approx(0.3, abs=2e-3)


def test_a_sine_is_followed_through_its_reversals():
    weigh = replace(MODEL, gravity_a=(0.3, 0.3), rotor_inertia_a_s2_rad=0.012)
    omega, seen, truth_a = pi, [], []
    for cycle in range(1600):
        time_s = cycle * PERIOD_S
        angle_rad = 0.8 * sin(omega * time_s) + 1.0
        speed, acceleration = 0.8 * omega * cos(omega * time_s), -0.8 * omega**2 * sin(omega * time_s)
        truth_a.append(0.3 * sin(angle_rad))
        seen.append(Observation(counted(angle_rad), motor_current_a(truth_a[-1], speed, acceleration)))
    estimates = follow(seen, weigh)[400:]
    errors_a = [one.load_current_a - a for one, a in zip(estimates, truth_a[400:], strict=True)]
    plain_a = [one.current_a - a for one, a in zip(seen[400:], truth_a[400:], strict=True)]
    assert sum(e**2 for e in errors_a) < sum(p**2 for p in plain_a) / 8**2
    assert {one.branch for one in estimates} == {Branch.MOVING, Branch.TURNING}


@pytest.mark.parametrize("wrong", [{"arm_inertia_a_s2_rad": (0.1,)}, {"offsets_a": (0.1,)}, {"ratio": 0.0}])
def test_models_that_do_not_fit_together_are_refused(wrong):
    with pytest.raises(ModelParameterError, match=next(iter(wrong))):
        replace(MODEL, **wrong)


WEIGHED = replace(MODEL, gravity_a=(0.3, 0.3))


def slide(speed, deceleration, start_rad=0.8, seconds=0.5):
    """A weight pushed up at a speed; with a deceleration it is slowed to a stop, by no more than its motor gives up."""
    at_rad, seen = start_rad, []
    for _ in range(round(seconds / PERIOD_S)):
        seen.append(Observation(counted(at_rad), motor_current_a(0.3 * sin(at_rad), speed, 0.0), 2.0))
        at_rad += speed * PERIOD_S
    while deceleration and speed > 0.0:
        seen.append(Observation(counted(at_rad), motor_current_a(0.3 * sin(at_rad), speed, -deceleration), 2.0))
        at_rad += speed * PERIOD_S
        speed -= deceleration * PERIOD_S
    return [*stand(0.3 * sin(start_rad), 60, start_rad, rest=RestResult(0.3 * sin(start_rad), 0.005, 0.1)), *seen]


def test_what_stops_a_joint_at_once_is_felt_at_once():
    free = slide(0.2, 0.0)
    # 2 ms of its speed into the wall, and there it stands under the same current
    at_rad, current_a = free[-1].position_rad + 0.0004, free[-1].current_a
    estimates = follow([*free, *stand(current_a, 30, at_rad, 2.0)], WEIGHED)[len(free) :]
    weight_a = 0.3 * sin(at_rad)
    assert Branch.STRUCK in {one.branch for one in estimates[:3]}
    # friction may hide any load up to 0.1 A more each way; its middle is far from the weight
    assert estimates[4].load_current_a > weight_a + 0.05
    assert estimates[-1].load_current_a == pytest.approx(estimates[4].load_current_a, abs=0.02)
    assert abs(estimates[-1].load_current_a - weight_a) < estimates[-1].half_width_a + 0.1


def test_a_harder_hit_wedges_more_until_it_swings_back():
    def left_a(speed):
        free = slide(speed, 0.0)
        held = stand(free[-1].current_a, 12, free[-1].position_rad + 0.0004, 2.0)
        return follow([*free, *held], WEIGHED)[-1].load_current_a

    soft, firm, hard = left_a(0.01), left_a(0.05), left_a(0.4)
    joint, at_rad = WEIGHED.under(0.1), 0.8 + 0.05 * 0.5
    far_a = joint.gear_loss.load_current_a(
        motor_current_a(0.3 * sin(at_rad), 0.05, 0.0) - joint.friction_a(0.0, -1.0), -1.0
    )
    assert soft < firm < far_a
    # J v / t beyond the weight: 0.022 A s2/rad, 0.05 rad/s, 8 ms
    assert firm - 0.3 * sin(at_rad) == pytest.approx(0.022 * 0.05 / 0.008, rel=0.3)
    assert hard < far_a - 0.1


def test_a_joint_that_is_thrown_back_by_what_it_struck_is_felt_at_once():
    free = slide(0.3, 0.0)
    at_rad, current_a = free[-1].position_rad, free[-1].current_a
    back = [Observation(at_rad + ahead_rad, current_a, 2.0) for ahead_rad in (0.0012, 0.0009, 0.0006)]
    found = follow([*free, *back, *stand(current_a, 20, at_rad + 0.0006, 2.0)], WEIGHED)[len(free) :]
    assert {one.branch for one in found[2:]} == {Branch.STRUCK}
    assert found[3].load_current_a > 0.3 * sin(at_rad) + 0.05


def test_a_joint_that_creeps_under_a_growing_current_presses_on():
    pushed = slide(0.2, 8.0)
    at_rad = pushed[-1].position_rad
    held = stand(pushed[-1].current_a, 30, at_rad, at_rad)
    # a count in four cycles: it never stands long enough to be stuck
    creep = [
        Observation(at_rad + cycle // 4 * COUNT_RAD, pushed[-1].current_a + 0.02 * cycle, 2.0) for cycle in range(1, 30)
    ]
    last = follow([*pushed, *held, *creep], WEIGHED)[-1]
    assert last.branch is Branch.TURNING
    # friction holds no more than 0.1 A of it
    assert last.load_current_a > (creep[-8].current_a - 0.12) / 1.25


@pytest.mark.parametrize("deceleration", [0.5, 2.0, 8.0])
def test_a_joint_that_its_motor_lets_stop_has_struck_nothing(deceleration):
    slowed = slide(0.2, deceleration)
    # friction holds it then, at what the motor last gave
    held = stand(slowed[-1].current_a, 30, slowed[-1].position_rad, 2.0)
    assert Branch.STRUCK not in {one.branch for one in follow([*slowed, *held], WEIGHED)}


def test_a_push_that_is_let_go_falls_with_the_current():
    pushed = slide(0.2, 0.0)
    at_rad = pushed[-1].position_rad + 0.0002
    # pressed to 0.7 A, then let go: the teeth spring back, a count in each cycle
    press = [Observation(at_rad, 0.3 + 0.01 * cycle, 2.0) for cycle in range(60)]
    held = stand(press[-1].current_a, 60, at_rad, 2.0)
    joint, back = WEIGHED.under(0.1), []
    for cycle in range(1, 40):
        load_a = max(0.6 - 0.01 * cycle, 0.3 * sin(at_rad))
        current_a = joint.gear_loss.motor_current_a(load_a, -1.0) + joint.friction_a(0.0, -1.0)
        back.append((load_a, Observation(at_rad - 2.0 * COUNT_RAD * cycle, current_a, 0.5)))
    seen = [*pushed, *press, *held]
    found = follow([*seen, *(one for _, one in back)], WEIGHED)[len(seen) :]
    errors_a = [one.load_current_a - load_a for one, (load_a, _) in zip(found, back, strict=True)]
    assert max(abs(error_a) for error_a in errors_a[3:]) < 0.02


def test_without_a_known_inertia_no_momentum_is_missed():
    light = replace(WEIGHED, rotor_inertia_a_s2_rad=0.0, arm_inertia_a_s2_rad=(0.0, 0.0))
    free = slide(0.2, 0.0)
    hit = [*free, *stand(free[-1].current_a, 30, free[-1].position_rad + 0.0004, 2.0)]
    assert Branch.STRUCK not in {one.branch for one in follow(hit, light)}
