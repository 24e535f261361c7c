"""Motion with the load estimated all along, on the simulated bench of the paper."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.config.reflected_load import load_current_a
from bench.errors import ConfigurationError, LimitError, ParameterError
from bench.experiments.kinds.steady_speeds import run_up, run_up_s
from bench.experiments.parts.load_follower import joint_model
from bench.experiments.registry import find_kind, parse_parameters
from tests.experiments.bench_run import Ran
from tests.experiments.calibrated import calibrated_configuration


@pytest.fixture(scope="module")
def swung():
    return Ran(calibrated_configuration(seed=11), "sinusoid", periods=2)


@pytest.fixture(scope="module")
def carried():
    return Ran(calibrated_configuration(seed=12), "steady-speeds", speeds_rad_s=(1.0, 2.0))


def test_swinging_the_estimate_is_eight_times_closer_than_the_current(swung):
    assert swung.summary["trials"] == 1
    assert swung.summary["rms_ratio"] < 1.0 / 8.0


def test_the_estimate_is_recorded_cycle_by_cycle_and_does_not_jump(swung):
    load_a = swung.channel(0, "current_load_a")
    known = load_a[~np.isnan(load_a)]
    assert len(known) > 400
    # 1.5 mA is what friction's own scatter makes from cycle to cycle
    assert np.max(np.abs(np.diff(known))) < 0.02


def test_the_band_is_recorded_beside_the_estimate_and_never_without_it(swung):
    load_a, half_a = swung.channel(0, "current_load_a"), swung.channel(0, "current_load_half_width_a")
    banded = np.isfinite(half_a)
    assert np.count_nonzero(banded) > 400
    assert np.all(np.isfinite(load_a[banded]))
    assert np.all(half_a[banded] > 0.0)
    truth_a = load_current_a(0.05, 1.0, calibrated_configuration().rig) / np.sin(1.0)
    off_a = np.abs(load_a - truth_a * np.sin(swung.channel(0, "position_rad")))
    assert np.mean(off_a[banded] <= half_a[banded]) > 0.8


def test_at_steady_speeds_the_load_is_carried_there_and_back(carried):
    assert carried.summary["speeds"] == 2
    for row in carried.summary["rows"]:
        assert abs(row["mean_error_kg"]) < 0.0015
        assert row["mean_absolute_error_kg"] < 0.1 * row["uncompensated_mean_absolute_error_kg"]


def test_the_band_is_no_ornament(swung, carried):
    assert swung.summary["in_band"] > 0.8
    assert carried.summary["in_band"] > 0.8


@pytest.mark.parametrize("kind", ["sinusoid", "steady-speeds"])
def test_every_trial_ends_at_rest_at_angle_0(kind, swung, carried):
    ran = swung if kind == "sinusoid" else carried
    for trial, outcome in enumerate(ran.outcomes):
        assert outcome.outcome == "completed"
        assert abs(ran.channel(trial, "position_rad")[-1]) < 0.01
        assert ran.channel(trial, "velocity_rad_s")[-1] == 0.0


@pytest.mark.parametrize("kind", ["sinusoid", "steady-speeds"])
def test_without_friction_curves_nothing_moves(kind):
    with pytest.raises(ConfigurationError, match="calibrate run"):
        Ran(default_configuration(), kind)


@pytest.mark.parametrize(
    ("kind", "wrong", "named"),
    [
        ("sinusoid", {"load_kg": 0.2}, "load_kg"),
        ("sinusoid", {"amplitude_rad": 2.2}, "amplitude_rad"),
        ("sinusoid", {"frequency_hz": 2.0}, "frequency_hz"),
        ("steady-speeds", {"load_kg": 0.2}, "load_kg"),
        ("steady-speeds", {"reach_rad": 2.2}, "reach_rad"),
        ("steady-speeds", {"speeds_rad_s": (9.0,)}, "speeds_rad_s"),
        ("steady-speeds", {"speeds_rad_s": (1e-4,)}, "speeds_rad_s"),
    ],
)
def test_what_the_bench_must_not_do_is_refused(kind, wrong, named):
    with pytest.raises(LimitError, match=named):
        Ran(calibrated_configuration(), kind, **wrong)


def test_a_run_up_that_leaves_no_way_is_refused():
    with pytest.raises(ParameterError, match="run_up_rad"):
        parse_parameters(find_kind("steady-speeds"), {"run_up_rad": 3.8})


@pytest.mark.parametrize("kind", ["sinusoid", "steady-speeds"])
def test_the_duration_is_about_what_it_takes(kind, swung, carried):
    ran, parameters = (swung, {"periods": 2}) if kind == "sinusoid" else (carried, {"speeds_rad_s": (1.0, 2.0)})
    configuration = calibrated_configuration()
    stated = find_kind(kind).duration_s(parse_parameters(find_kind(kind), parameters), configuration)
    taken = sum(outcome.cycles for outcome in ran.outcomes) * configuration.control.period_s
    assert 0.5 * taken < stated < 2.0 * taken


def test_a_failed_search_ends_the_trial_without_a_number():
    plain = calibrated_configuration()
    blocked = plain.model_copy(update={"search": plain.search.model_copy(update={"ceiling_a": 0.05})})
    results = Ran(blocked, "sinusoid", periods=1).outcomes[0].results
    assert "ceiling" in results["search_failure"]
    assert results["estimates"] == 0


def test_without_known_loads_the_model_has_no_gear_loss():
    plain = calibrated_configuration()
    assert joint_model(plain).gear_loss.driving > 0.2
    assert joint_model(plain.model_copy(update={"rest": None})).gear_loss.driving == 0.0


def test_a_run_up_ends_at_speed_without_acceleration():
    way_rad, speed_rad_s = 1.5, 6.0
    times_s = np.linspace(0.0, run_up_s(way_rad, speed_rad_s), 2001)
    gone_rad, speed = np.array([run_up(way_rad, speed_rad_s, time_s) for time_s in times_s]).T
    assert (gone_rad[-1], speed[-1]) == pytest.approx((way_rad, speed_rad_s))
    np.testing.assert_allclose(np.gradient(gone_rad, times_s)[1:-1], speed[1:-1], atol=1e-4)
    acceleration = np.gradient(speed, times_s)
    assert acceleration[-2] < 0.01 * acceleration[0]
    assert np.max(acceleration) == pytest.approx(acceleration[0])
