"""What known loads tell of a joint at rest, and what it corrects."""

from dataclasses import replace
from math import copysign, pi, sin

import numpy as np
import pytest

from compensator.errors import CalibrationError
from compensator.rest.breakaway_fit import Breakaway, fit
from compensator.rest.rest_calibration import RestCalibration, RestPoint, calibrate

GAIN, STEP_A, ASYMMETRY, SLOPE, OFFSET_A = 1.03, 0.002, 0.15, 0.24, 0.004
FULL_A, SCATTER = 4.9, 0.015  # A per kg at 90 degrees


def searched(load_a, load_kg, generator=None, pairs=4):
    """One search on a joint that is exactly as the calibration describes it, but for scatter."""
    friction_a = 0.1 + 1.7 * load_kg
    touches = 1.0 if abs(load_a) > OFFSET_A else 0.0  # less, and the arm's own friction holds it: the teeth are free
    mean_a = touches * GAIN * load_a + STEP_A * copysign(touches, load_a) + ASYMMETRY * friction_a
    half_a = friction_a + touches * (SLOPE * abs(load_a) + OFFSET_A)
    found = []
    for pair in range(pairs):
        for sign in (1.0, -1.0):
            noise_a = SCATTER * half_a * generator.standard_normal() if generator else 0.0
            rate = (0.6, 0.15)[pair % 2]
            found.append(Breakaway(sign, mean_a + sign * (half_a + 0.03 * rate ** (2 / 3)) + noise_a, rate))
    return fit(found)


def points(generator=None, repeats=1, loads=(0.0, 0.03, 0.06, 0.1), angles=(0.0, pi / 2)):
    return [
        RestPoint(FULL_A * load_kg * sin(angle), load_kg, searched(FULL_A * load_kg * sin(angle), load_kg, generator))
        for load_kg in loads
        for angle in angles
        for _ in range(repeats)
    ]


def test_every_constant_is_found_where_nothing_scatters():
    found = calibrate(points())
    assert found.gain == pytest.approx(GAIN)
    assert found.step_a == pytest.approx(STEP_A)
    assert found.asymmetry == pytest.approx(ASYMMETRY)
    assert found.slope == pytest.approx(SLOPE)
    assert found.offset_a == pytest.approx(OFFSET_A)


@pytest.mark.parametrize("load_kg", [0.0, 0.02, 0.05, 0.09])
@pytest.mark.parametrize("angle", [-pi / 2, 0.0, 1.0, pi / 2])
def test_the_load_comes_out_under_any_load_at_any_angle(load_kg, angle):
    load_a = FULL_A * load_kg * sin(angle)
    estimate = calibrate(points()).estimate(searched(load_a, load_kg))
    assert estimate.load_current_a.value == pytest.approx(load_a, abs=1e-9)
    assert estimate.friction_current_a.value == pytest.approx(0.1 + 1.7 * load_kg, abs=1e-9)


def test_the_interval_of_the_load_holds_the_truth_in_95_of_100():
    generator, held, trials = np.random.default_rng(4), 0, 0
    for _ in range(60):
        calibration = calibrate(points(generator, repeats=3))
        for load_kg in (0.02, 0.05, 0.08):
            load_a = FULL_A * load_kg
            for _ in range(5):
                told = calibration.estimate(searched(load_a, load_kg, generator)).load_current_a
                held += told.low <= load_a <= told.high
                trials += 1
    assert 0.92 <= held / trials <= 0.98


def test_what_the_arms_own_friction_holds_is_within_the_interval():
    """A load that rests on the arm's bearings never reaches the motor: the search cannot tell it from none."""
    calibration = calibrate(points())
    for load_a in (-0.9 * OFFSET_A, 0.0, 0.5 * OFFSET_A, 0.9 * OFFSET_A):
        told = calibration.estimate(searched(load_a, 0.03)).load_current_a
        assert told.value == 0.0
        assert told.low <= load_a <= told.high
        assert told.high - told.low < 3.0 * OFFSET_A  # and hardly more than that


def test_no_search_is_told_without_a_width():
    """Between what free teeth may show and the least that teeth in touch do lies a gap that scatter may fall into."""
    calibration = calibrate(points(np.random.default_rng(6), repeats=3))
    for load_a in np.linspace(-2.0 * OFFSET_A, 2.0 * OFFSET_A, 81):
        mean_a = load_a + ASYMMETRY * 0.185
        found = [Breakaway(sign, mean_a + sign * 0.19, rate) for rate in (0.6, 0.15) for sign in (1.0, -1.0)]
        told = calibration.estimate(fit(found)).load_current_a
        assert told.high - told.low > 1e-3
        assert told.low <= told.value <= told.high


def test_a_search_that_scatters_by_far_more_than_the_joint_did_is_told_by_its_own_scatter():
    calibration = calibrate(points(np.random.default_rng(6), repeats=3))
    calm = searched(0.245, 0.05, np.random.default_rng(7))
    # one breakaway too early by far: something has pushed the arm
    pushed = calm._replace(scatter_a=20.0 * calm.scatter_a)
    usual, wide = (calibration.estimate(one).load_current_a for one in (calm, pushed))
    assert wide.high - wide.low > 5.0 * (usual.high - usual.low)


def test_the_interval_is_honest_from_free_teeth_to_full_load():
    generator = np.random.default_rng(5)
    held = {"free": [], "light": [], "full": []}
    ranges = {"free": (0.0, OFFSET_A), "light": (OFFSET_A, 4.0 * OFFSET_A), "full": (0.1, 0.45)}
    for _ in range(40):
        calibration = calibrate(points(generator, repeats=3))
        for name, (low_a, high_a) in ranges.items():
            for load_a in generator.uniform(low_a, high_a, 6) * generator.choice((-1.0, 1.0), 6):
                told = calibration.estimate(searched(load_a, 0.05, generator)).load_current_a
                held[name].append(told.low <= load_a <= told.high)
    assert all(np.mean(found) >= 0.92 for found in held.values()), {k: np.mean(v) for k, v in held.items()}
    assert np.mean(held["full"]) <= 0.985


def test_gear_loss_in_motion_follows():
    loss = calibrate(points()).gear_loss()
    assert loss.driving == pytest.approx(SLOPE + GAIN - 1.0)
    assert loss.back_driving == pytest.approx(SLOPE - GAIN + 1.0)
    assert loss.carried_a == pytest.approx(2.0 * SLOPE * calibrate(points()).friction_behind_a)


def test_friction_behind_the_teeth_is_what_both_constants_tell_each_as_it_is_sure():
    told = RestCalibration(slope=0.25, step_a=0.0025, offset_a=0.006, offset_sd_a=0.001)
    step_is_sure = ((0.0,) * 3, (0.0, 1e-12, 0.0), (0.0,) * 3)
    step_is_unsure = ((0.0,) * 3, (0.0, 1e-4, 0.0), (0.0,) * 3)
    assert replace(told, covariance=step_is_sure).friction_behind_a == pytest.approx(0.01, rel=1e-3)
    assert replace(told, covariance=step_is_unsure).friction_behind_a == pytest.approx(0.006, rel=1e-2)
    assert replace(told, covariance=step_is_unsure, offset_a=-0.01).friction_behind_a == 0.0


def test_nothing_known_is_eqs_9_and_10():
    found = searched(0.3, 0.06)
    estimate = RestCalibration().estimate(found)
    assert estimate.load_current_a.value == pytest.approx(found.load_current_a.value)
    assert estimate.friction_current_a.value == pytest.approx(found.ramped_a)


@pytest.mark.parametrize(
    "few",
    [
        points(loads=(0.0, 0.05)),
        points(angles=(0.0,), repeats=3),
        points(loads=(0.05,), repeats=4),
        points(angles=(pi / 2,), repeats=3),
    ],
)
def test_searches_that_do_not_tell_are_refused(few):
    with pytest.raises(CalibrationError, match="load sweep"):
        calibrate(few)


def weighed(generator, known):
    """Searches whose ramps gain as the inertia says: the rotor's, and under a load the arm's, too."""
    found = []
    for point in points(generator, repeats=3):
        inertia = 0.012 + (0.01 + 0.25 * point.load_kg if point.load_current_a != 0.0 else 0.0)
        gained = 0.1 * inertia ** (1.0 / 3.0) - 0.03
        shifted = point.found._replace(
            delay=point.found.delay + gained, ramped_a=point.found.ramped_a + gained * point.found.ramp
        )
        found.append(point._replace(found=shifted, inertia_kg_m2=inertia if known else float("nan")))
    return found


def test_where_the_inertia_is_known_gear_loss_is_told_better():
    errors = {
        known: [calibrate(weighed(np.random.default_rng(seed), known)).slope - SLOPE for seed in range(30)]
        for known in (True, False)
    }
    assert abs(np.mean(errors[True])) < 0.002
    assert np.std(errors[True]) < 0.5 * np.std(errors[False])
