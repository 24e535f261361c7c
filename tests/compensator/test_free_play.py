"""An arm that falls through the free play of its gear: where it is, and that its fall is taken for no load."""

from dataclasses import replace
from math import pi, sin

import numpy as np
import pytest

from compensator.motion import free_play, load_estimator
from compensator.motion.friction_lookup import FrictionLookup
from compensator.motion.gear_loss import GearLoss
from compensator.motion.kinetic_friction import KineticFriction
from compensator.motion.load_estimator import EstimatorSettings, JointModel, Observation, RestResult

PERIOD_S, FINE_STEPS, PLAY_RAD, COUNT_RAD = 0.005, 50, 0.01, 2.0 * pi / 4096 / 20
RUBS_A, LOSS, GRAVITY_A, INERTIA = 0.005, 0.25, 0.49, 0.035
CURVE = KineticFriction(0.16, 0.27, 5.0, 2.0, 2e-3)
MODEL = JointModel(
    FrictionLookup.over_friction({0.1: CURVE, 0.27: CURVE}),
    ratio=20.0,
    rotor_inertia_a_s2_rad=0.012,
    arm_inertia_a_s2_rad=(INERTIA, INERTIA),
    gravity_a=(GRAVITY_A, GRAVITY_A),
    gear_loss=GearLoss(LOSS, LOSS, 2.0 * LOSS * RUBS_A),
)
SETTINGS = EstimatorSettings(PERIOD_S, COUNT_RAD, PLAY_RAD, dead_band_rad=0.004, window=30, blend_s=PERIOD_S)


def carry(speed_rad_s, start_rad, end_rad):
    """A motor that turns steadily, whatever the arm does: (its angle, its current, the arm's angle) of every cycle.

    Written without the estimator: small steps, and the teeth as a wall on either side that takes all speed.
    """
    step_s, way = PERIOD_S / FINE_STEPS, (1.0 if speed_rad_s > 0.0 else -1.0)
    motor, rotating_a = start_rad, MODEL.under(0.27).friction_a(speed_rad_s, way)
    arm, arm_rad_s = motor - PLAY_RAD / 2.0 * (1.0 if start_rad > 0.0 else -1.0), speed_rad_s
    cycles = []
    while way * motor < way * end_rad:
        sum_a = 0.0
        for _ in range(FINE_STEPS):
            motor += speed_rad_s * step_s
            fallen_rad_s = arm_rad_s - (GRAVITY_A * sin(arm) + way * RUBS_A) / INERTIA * step_s
            arm += fallen_rad_s * step_s
            touches = abs(arm - motor) >= PLAY_RAD / 2.0
            arm = min(max(arm, motor - PLAY_RAD / 2.0), motor + PLAY_RAD / 2.0)
            arm_rad_s = speed_rad_s if touches else fallen_rad_s
            teeth_a = INERTIA * (arm_rad_s - fallen_rad_s) / step_s
            lost_a = LOSS * abs(teeth_a) * way
            # the friction of the balanced joint holds the arm's, and what the teeth lose of it
            sum_a += rotating_a - way * RUBS_A * (1.0 + LOSS) + teeth_a + lost_a
        cycles.append((round(motor / COUNT_RAD) * COUNT_RAD, sum_a / FINE_STEPS, arm))
    return cycles


@pytest.mark.parametrize("speed_rad_s", [0.5, 3.0, 6.0, -6.0])
def test_the_arm_is_found_behind_the_free_play(speed_rad_s):
    way = 1.0 if speed_rad_s > 0.0 else -1.0
    cycles, joint = carry(speed_rad_s, -1.4 * way, 1.4 * way), MODEL.under(0.27)
    arm = free_play.begin(cycles[0][0], -way, PLAY_RAD)
    misses = []
    for motor_rad, _, true_rad in cycles[1:]:
        arm = free_play.follow(joint, arm, motor_rad, 0.0, PLAY_RAD, PERIOD_S)
        misses.append(abs(arm.angle_rad - true_rad))
    # whoever takes the arm for the motor is half the free play off
    assert np.percentile(misses[10:], 95) < 0.1 * PLAY_RAD


@pytest.mark.parametrize("speed_rad_s", [0.5, 3.0, 6.0, -6.0])
def test_an_arm_that_falls_through_the_free_play_changes_no_load(speed_rad_s):
    way = 1.0 if speed_rad_s > 0.0 else -1.0
    cycles = carry(speed_rad_s, -2.6 * way, 1.4 * way)
    start_a = GRAVITY_A * sin(cycles[0][0])
    hangs = Observation(cycles[0][0], start_a, rest=RestResult(start_a, 0.002, 0.27))
    state, _ = load_estimator.advance(MODEL, SETTINGS, load_estimator.begin(0.27), hangs)
    errors_a = []
    for motor_rad, current_a, _ in cycles:
        state, estimate = load_estimator.advance(MODEL, SETTINGS, state, Observation(motor_rad, current_a))
        errors_a.append(estimate.load_current_a - GRAVITY_A * sin(motor_rad))
    # this motor was at speed at once; that is out of the window now
    errors_a = errors_a[2 * SETTINGS.window + 5 :]
    # 1 g at the tip is 4.9 mA; the arm's own fall is worth 70
    assert max(abs(error_a) for error_a in errors_a) < 0.012


def test_an_arm_without_inertia_lies_where_its_load_puts_it():
    joint = replace(MODEL, arm_inertia_a_s2_rad=(0.0, 0.0)).under(0.27)
    arm = free_play.begin(0.5, 1.0, PLAY_RAD)
    arm = free_play.follow(joint, arm, 0.5, 0.0, PLAY_RAD, PERIOD_S)
    assert arm.angle_rad == pytest.approx(0.5 - PLAY_RAD / 2.0)
    assert arm.teeth_a == pytest.approx(GRAVITY_A * sin(0.5), rel=0.02)


def test_teeth_that_meet_share_their_momentum():
    joint = MODEL.under(0.27)
    at_rest = free_play.begin(0.0, 1.0, PLAY_RAD)
    # the arm flies ahead of a motor that stands, until the other flank stops it
    flying = at_rest._replace(speed_rad_s=3.0, side=0.0)
    met = free_play.follow(joint, flying, 0.0, 0.0, PLAY_RAD, PERIOD_S)
    assert met.side == -1.0
    assert met.speed_rad_s == pytest.approx(3.0 * INERTIA / (INERTIA + 0.012), rel=0.02)
