"""The speed sweep on the simulated bench of the paper: steady speeds within a finite travel."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.errors import LimitError, ParameterError
from bench.experiments.parts.profile import Halt
from bench.experiments.registry import find_kind, parse_parameters
from tests.experiments.bench_run import Ran

CONFIGURATION = default_configuration()
CHOSEN = {"currents_a": (0.05, 0.25, 0.4), "duties": (0.2,), "speeds_rad_s": (0.1, 1.0)}


@pytest.fixture(scope="module")
def sweep():
    return Ran(CONFIGURATION, "speed-sweep", loads_kg=(0.0, 0.1), **CHOSEN)


def plant_friction_a(speed_rad_s, load_kg):
    """What the preset says of itself, at the joint: Kt N = 1 N m/A. Written out, not asked of the simulation."""
    motor_rad_s, growth = 20.0 * speed_rad_s, 1.0 + 1.7 * 9.80665 * load_kg
    motor_n_m = (3e-3 + 2e-3 * np.exp(-((motor_rad_s / 5.0) ** 2))) * growth + 1.05e-4 * motor_rad_s
    arm_n_m = 5e-3 + 1e-3 * np.exp(-((speed_rad_s / 0.25) ** 2)) + 1e-3 * speed_rad_s
    return 20.0 * motor_n_m + 1.25 * arm_n_m  # the mesh loses a quarter of what it carries


def rows(sweep, **wanted):
    return [row for row in sweep.summary["rows"] if all(row.get(name) == value for name, value in wanted.items())]


def test_every_trial_completes_within_the_travel_and_ends_at_angle_0(sweep):
    assert [outcome.outcome for outcome in sweep.outcomes] == ["completed"] * 24
    for trial in range(24):
        position_rad = sweep.channel(trial, "position_rad")
        assert np.max(np.abs(position_rad)) < 2.2
        assert abs(position_rad[-1]) < 0.1


def test_steady_points_lie_on_the_friction_curve_of_the_plant(sweep):
    saturated = rows(sweep, saturated=True)
    assert len(saturated) >= 18
    for row in saturated:
        # 2 % of scatter along the path, of which some tens average out; 2 % of the speed is still to come, which is
        # worth 2 % of the viscous share; one count of the duty is 3 mA
        expected_a = plant_friction_a(row["speed_rad_s"], row["load_kg"])
        assert row["current_a"] == pytest.approx(expected_a, abs=0.003 + 0.03 * expected_a)


def test_a_current_below_friction_stalls(sweep):
    for row in rows(sweep, held_current_a=0.05):
        assert row["speed_rad_s"] == 0.0
        assert not row["saturated"]
        assert row["ending"].startswith("stalled")


def test_a_current_that_leads_beyond_the_top_speed_is_named_and_not_chased(sweep):
    for row in rows(sweep, held_current_a=0.4, load_kg=0.0):
        assert row["ending"] == "its steady speed lies above top_speed_rad_s"
    for trial in range(len(sweep.plans)):
        assert np.max(np.abs(sweep.channel(trial, "velocity_rad_s"))) < CONFIGURATION.limits.speed_rad_s


def test_a_held_speed_is_reached_from_above_and_below_in_time_constants_of_the_plant(sweep):
    heavy, light = (rows(sweep, held_current_a=0.25, load_kg=load, direction="forward")[0] for load in (0.1, 0.0))
    assert heavy["speed_rad_s"] < 0.6 * light["speed_rad_s"]
    assert light["motor_speed_rad_s"] == pytest.approx(20.0 * light["speed_rad_s"])
    assert abs(light["remaining_speed_rad_s"]) <= 0.02 * light["speed_rad_s"]


def test_what_is_held_is_what_flows(sweep):
    for row in rows(sweep, held_duty=0.2):
        assert row["duty"] == pytest.approx(0.2)
    for row in rows(sweep, held_current_a=0.25):
        assert row["current_a"] == pytest.approx(0.25, abs=0.003)
    for row in rows(sweep, held_speed_rad_s=1.0):
        assert row["speed_rad_s"] == pytest.approx(1.0, rel=0.01)


def test_conditions_say_what_was_held_constant(sweep):
    assert sweep.plans[0].conditions == {
        "load_kg": 0.0, "balanced": True, "direction": "forward", "held_speed_rad_s": 0.1, "arm_m": 0.5,
    }  # fmt: skip
    assert len({plan.name for plan in sweep.plans}) == len(sweep.plans)
    assert all(plan.balanced for plan in sweep.plans)


def test_the_estimated_duration_is_about_right(sweep):
    kind = find_kind("speed-sweep")
    estimated_s = kind.duration_s(parse_parameters(kind, {"loads_kg": (0.0, 0.1), **CHOSEN}), CONFIGURATION)
    taken_s = sum(outcome.cycles for outcome in sweep.outcomes) * CONFIGURATION.control.period_s
    assert 0.5 < estimated_s / taken_s < 2.0


def test_an_arm_that_turns_freely_saturates_at_2000_rpm():
    # Fig. 2 goes to 2000 rpm, 10.5 rad/s at the joint: no travel of 4.4 rad allows that, a balanced arm that turns does
    limits = CONFIGURATION.limits.model_copy(
        update={"position_min_rad": -60.0, "position_max_rad": 60.0, "speed_rad_s": 12.0}
    )
    free = CONFIGURATION.model_copy(update={"limits": limits})
    ran = Ran(
        free, "speed-sweep", loads_kg=(0.0,), currents_a=(0.5,), speeds_rad_s=(), top_speed_rad_s=10.8, hold_s=4.0
    )
    assert all(row["saturated"] for row in ran.summary["rows"])
    for row in ran.summary["rows"]:
        assert row["motor_speed_rad_s"] > 195.0
        assert row["current_a"] == pytest.approx(plant_friction_a(row["speed_rad_s"], 0.0), rel=0.03)


REFUSED = [
    ({"loads_kg": [0.2]}, "a load of loads_kg is 0.2 kg; allowed is at most 0.1 kg"),
    ({"top_speed_rad_s": 7.0}, "top_speed_rad_s is 7 rad/s; allowed is at most 6.366 rad/s. Run-up and braking"),
    ({"top_speed_rad_s": 7.5}, "top_speed_rad_s and a tenth is 8.25 rad/s; allowed is at most 8 rad/s"),
    ({"speeds_rad_s": [6.5]}, "a speed of speeds_rad_s is 6.5 rad/s; allowed is at most 6.366"),
    ({"window_s": 1.0}, "top_speed_rad_s is 6.3 rad/s; allowed is at most"),
    ({"currents_a": [2.5]}, "a current of currents_a is 2.5 A; allowed is at most limits.current_a, 2 A"),
    ({"duties": [0.7]}, "a duty of duties is 0.7; allowed is at most 0.6667, which is limits.current_a"),
]


@pytest.mark.parametrize(("parameters", "message"), REFUSED)
def test_what_lies_outside_the_limits_is_refused_before_motion(parameters, message):
    kind = find_kind("speed-sweep")
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, parameters), CONFIGURATION)
    assert str(caught.value).startswith(message)


MALFORMED = [
    ({"currents_a": [], "speeds_rad_s": []}, "at least one of currents_a, duties, speeds_rad_s must not be empty"),
    ({"currents_a": [-0.1]}, "speed-sweep: currents_a.0: found -0.1; should be greater than 0"),
    ({"duties": [1.5]}, "speed-sweep: duties.0: found 1.5; should be less than or equal to 1"),
    ({"hold_s": 0.2}, "hold_s must be at least twice window_s, 0.3 s"),
    ({"tolerance": 0.0}, "speed-sweep: tolerance: found 0.0; should be greater than 0"),
]


@pytest.mark.parametrize(("parameters", "message"), MALFORMED)
def test_malformed_parameters_are_named(parameters, message):
    with pytest.raises(ParameterError) as caught:
        parse_parameters(find_kind("speed-sweep"), parameters)
    assert message in str(caught.value)


@pytest.mark.parametrize("speed", [4.0, -4.0])
def test_a_halt_by_hand(speed):
    # 4 rad/s at 8 rad/s2: 0.5 s and 1 rad
    halt = Halt(1.0, speed, 8.0)
    sign = np.sign(speed)
    assert halt.duration_s == pytest.approx(0.5)
    assert halt.at(0.25) == pytest.approx((1.0 + sign * 0.75, sign * 2.0))
    assert halt.at(9.0) == pytest.approx((1.0 + sign, 0.0))
