"""Friction curves from steady points of a plant whose curve is known."""

import numpy as np
import pytest

from compensator.errors import CalibrationError
from compensator.motion.friction_calibration import NOT_COVERED, NOT_TOLD, check_points, fit
from compensator.motion.kinetic_friction import KineticFriction
from compensator.motor.dc_motor import MotorConstants, current_a

# the balanced joint of the paper's rig under 100 g, at the motor shaft
TRUE = KineticFriction(coulomb_a=0.16, static_a=0.27, stribeck_speed_rad_s=5.0, shape=2.0, viscous_a_s_rad=2.1e-3)
OFFSET_A, RISE_OFFSET_A = 0.01, 0.02  # unequal both ways: dry friction, and its rise towards rest
NOISE_A = 0.003
TRUTH = {
    "coulomb_a": 0.16,
    "static_a": 0.27,
    "stribeck_speed_rad_s": 5.0,
    "shape": 2.0,
    "viscous_a_s_rad": 2.1e-3,
    "offset_a": OFFSET_A,
    "rise_offset_a": RISE_OFFSET_A,
}
ONE_WAY = np.array([0.6, 1.2, 2.0, 4.0, 6.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0])
SPEEDS = np.concatenate([ONE_WAY, -ONE_WAY])


def unequal_a(speeds, offset_a=OFFSET_A, rise_offset_a=RISE_OFFSET_A, stribeck_speed_rad_s=5.0, shape=2.0):
    return offset_a + rise_offset_a * np.exp(-((np.abs(speeds) / stribeck_speed_rad_s) ** shape))


def measured(seed, noise_a=NOISE_A, speeds=SPEEDS):
    scatter = np.random.default_rng(seed).normal(0.0, noise_a, len(speeds)) if noise_a else 0.0
    return TRUE.sliding_a(speeds) + unequal_a(speeds) + scatter


def test_without_noise_the_parameters_are_recovered():
    found = fit(SPEEDS, measured(0, noise_a=0.0))
    for name, true in TRUTH.items():
        assert found.parameters[name].value == pytest.approx(true, rel=1e-4), name
    assert found.points == 24


def least_deviations():
    """Cramer-Rao, worked here by finite differences of eq. (2), not by the code under test."""

    def model(p):
        return KineticFriction(*p[:5]).sliding_a(SPEEDS) + unequal_a(SPEEDS, p[5], p[6], p[2], p[3])

    p = np.array(list(TRUTH.values()))
    steps = np.diag(1e-5 * np.maximum(np.abs(p), 1e-3))
    columns = np.column_stack([(model(p + step) - model(p - step)) / (2 * np.sum(step)) for step in steps])
    return dict(zip(TRUTH, NOISE_A * np.sqrt(np.diag(np.linalg.inv(columns.T @ columns))), strict=True))


def test_with_noise_the_parameters_are_recovered_as_closely_as_theory_allows():
    fits = [fit(SPEEDS, measured(seed)).parameters for seed in range(60)]
    for name, deviation in least_deviations().items():
        values = np.array([one[name].value for one in fits])
        # unbiased: within 4 deviations of the mean of 60; and the loss is robust at the price of a tenth
        assert abs(np.mean(values) - TRUTH[name]) < 4.0 * deviation / np.sqrt(60), name
        assert np.std(values) < 1.35 * deviation, name
        held = sum(one[name].low <= TRUTH[name] <= one[name].high for one in fits)
        # of 60 at 95 %: 57 expected; below 50 is one in 2000 by chance
        assert held >= 50, name
        width = np.median([one[name].high - one[name].low for one in fits])
        assert width == pytest.approx(2 * 2.1 * deviation, rel=0.4), name  # 2.1: Student's t of 18 degrees


def test_intervals_hold_where_slow_points_scatter_more():
    # at creeping speed a window averages over little of the path: four times the scatter below the Stribeck speed
    deviations = np.where(np.abs(SPEEDS) < 5.0, 4.0, 1.0) * NOISE_A
    held = 0
    for seed in range(60):
        noise_a = np.random.default_rng(seed).normal(0.0, deviations)
        interval = fit(SPEEDS, TRUE.sliding_a(SPEEDS) + OFFSET_A + noise_a).parameters["static_a"]
        held += interval.low <= TRUE.static_a <= interval.high
    assert held >= 50  # 57 expected at 95 %; one scatter for all points holds 45


def test_an_outlier_moves_nothing():
    current_a = measured(3)
    clean = fit(SPEEDS, current_a)
    current_a[5] += 0.1  # a joint that hit something: 30 deviations
    spoiled = fit(SPEEDS, current_a)
    for name in ("coulomb_a", "static_a", "viscous_a_s_rad"):
        width = clean.parameters[name].high - clean.parameters[name].low
        assert abs(spoiled.parameters[name].value - clean.parameters[name].value) < width / 2


def test_without_a_rise_at_low_speed_static_friction_is_not_told():
    flat = KineticFriction(0.2, 0.2, 5.0, viscous_a_s_rad=2e-3)
    found = fit(SPEEDS, flat.sliding_a(SPEEDS) + np.random.default_rng(1).normal(0.0, NOISE_A, len(SPEEDS)))
    assert found.parameters["stribeck_speed_rad_s"].note == NOT_TOLD
    assert np.isnan(found.parameters["shape"].low)
    assert found.curve.sliding_a(50.0) == pytest.approx(flat.sliding_a(50.0), abs=2 * NOISE_A)


def test_a_stribeck_speed_below_the_points_is_said_to_be_extrapolated():
    narrow = KineticFriction(0.16, 0.6, 1.0, shape=1.0, viscous_a_s_rad=2e-3)
    speeds = np.concatenate([ONE_WAY[1:], -ONE_WAY[1:]])
    found = fit(speeds, narrow.sliding_a(speeds) + np.random.default_rng(2).normal(0.0, 5e-5, len(speeds)))
    assert found.parameters["stribeck_speed_rad_s"].note == NOT_COVERED


def test_coulomb_and_viscous_friction_alone():
    speeds = np.array([30.0, 60.0, 90.0, -30.0, -60.0, -90.0])
    found = fit(speeds, np.sign(speeds) * 0.2 + 2e-3 * speeds, stribeck=False)
    assert found.curve.coulomb_a == found.curve.static_a == pytest.approx(0.2)
    assert found.parameters["viscous_a_s_rad"].value == pytest.approx(2e-3)
    assert found.parameters["static_a"].note == NOT_TOLD


def test_duties_give_the_same_curve():
    constants = MotorConstants(8.0, 0.05)
    duty = (8.0 * measured(0, noise_a=0.0) + 0.05 * SPEEDS) / 24.0
    found = fit(SPEEDS, current_a(constants, duty, SPEEDS, 24.0))
    assert found.curve.coulomb_a == pytest.approx(0.16, rel=1e-4)


NAN = float("nan")
WRONG = [
    (SPEEDS[:3], np.ones(3), "there are 3 points; allowed is at least 10"),
    (np.abs(SPEEDS), np.ones(24), "there are 0 points moving backward; allowed is at least 2"),
    (-np.abs(SPEEDS), np.ones(24), "there are 0 points moving forward"),
    (np.where(np.abs(SPEEDS) < 20, 50.0 + SPEEDS, SPEEDS), np.ones(24), "the lowest speed is"),
    (np.where(SPEEDS == 0.6, 0.0, SPEEDS), np.ones(24), "speed of point 0 is 0 rad/s; allowed is any other"),
    (np.sign(SPEEDS), np.ones(24), "there are 1 different speeds; allowed is at least 5"),
    (np.where(SPEEDS == 2.0, NAN, SPEEDS), np.ones(24), "speed of point 2 is nan rad/s"),
    (SPEEDS, np.where(SPEEDS == 4.0, np.inf, 1.0), "current of point 3 is inf A"),
    (SPEEDS, np.ones(23), "speeds have shape (24,) and currents (23,)"),
    (SPEEDS[:, None], np.ones((24, 1)), "speeds have shape (24, 1)"),
]


@pytest.mark.parametrize(("speed", "current", "message"), WRONG)
def test_points_that_cannot_carry_a_curve_are_refused(speed, current, message):
    with pytest.raises(CalibrationError) as caught:
        fit(speed, current)
    assert str(caught.value).startswith(message)


def test_no_low_speeds_says_what_would_help():
    speeds = np.concatenate([ONE_WAY[6:], -ONE_WAY[6:]])
    with pytest.raises(
        CalibrationError, match=r"lowest speed is 20 rad/s; allowed is at most 12 rad/s.*stribeck=False"
    ):
        check_points(speeds, measured(0, speeds=speeds))
