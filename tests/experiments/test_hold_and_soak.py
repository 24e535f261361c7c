"""Hold and soak on simulated joints that warm up, run in, or do neither."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.errors import LimitError, ParameterError
from bench.experiments.kinds.hold_and_soak import HoldAndSoakParameters
from bench.experiments.registry import find_kind, parse_parameters
from tests.experiments.bench_run import Ran
from tests.experiments.plants import bench_with

CHOSEN = {"soak_s": 20.0, "probe_every_s": 10.0, "probe_rad": 0.3}


@pytest.fixture(scope="module")
def held():
    return Ran(default_configuration(), "hold-and-soak", **CHOSEN)


def test_probes_stand_before_between_and_after_the_soaks(held):
    assert [plan.name for plan in held.plans] == ["probe-001", "soak-001", "probe-002", "soak-002", "probe-003"]
    assert [plan.conditions["soaked_s"] for plan in held.plans] == [0.0, 0.0, 10.0, 10.0, 20.0]
    assert {outcome.outcome for outcome in held.outcomes} == {"completed"}
    for trial in range(len(held.plans)):
        assert abs(held.channel(trial, "position_rad")[-1]) < 0.01


def test_the_load_is_held_for_the_time(held):
    position_rad = held.channel(1, "position_rad")
    assert np.count_nonzero(np.abs(position_rad - np.pi / 2) < 0.02) * 0.005 == pytest.approx(10.0, abs=0.5)
    assert held.outcomes[1].results["rms_current_a"] > 0.2


def test_a_joint_that_does_not_change_shows_no_change(held):
    # 100 g: Coulomb friction 0.16 A, viscous 0.02 A, arm side and mesh 0.02 A; 2 % of scatter along the path
    assert held.summary["probes"] == 3
    assert held.summary["rows"][0]["friction_current_a"] == pytest.approx(0.2, rel=0.15)
    assert abs(held.summary["change_friction_current_a"]) < 0.01


def test_moving_runs_a_new_gear_in():
    running_in = bench_with(run_in={"fraction": 0.5, "distance_rad": 400.0})
    ran = Ran(running_in, "hold-and-soak", soak="move", **CHOSEN)
    friction_a = [row["friction_current_a"] for row in ran.summary["rows"]]
    assert friction_a == sorted(friction_a, reverse=True)
    assert ran.summary["change_friction_current_a"] < -0.02
    swing_rad = ran.channel(1, "position_rad")
    assert np.max(swing_rad) == pytest.approx(np.pi / 2, abs=0.1)
    assert np.max(np.abs(ran.channel(1, "velocity_rad_s"))) == pytest.approx(3.0, rel=0.2)


def test_the_last_part_is_what_is_left():
    assert HoldAndSoakParameters(soak_s=25.0, probe_every_s=10.0).soaks_s == [10.0, 10.0, 5.0]
    assert HoldAndSoakParameters(soak_s=30.0, probe_every_s=10.0).soaks_s == [10.0, 10.0, 10.0]


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"load_kg": 0.2}, "load_kg is 0.2 kg"),
        ({"hold_rad": 2.2}, "hold_rad is 2.2 rad"),
        ({"probe_rad": 2.2}, "probe_rad is -2.2 rad"),
        ({"probe_rad_s": 9.0}, "probe_rad_s is 9 rad/s"),
        ({"soak": "move", "move_rad_s": 7.0}, "the acceleration of the motion is 62."),
        ({"soak": "move", "hold_rad": 0.01}, "hold_rad is 0.01 rad; allowed is at least 0.1"),
    ],
)
def test_what_the_bench_must_not_do_is_refused(wrong, named):
    kind = find_kind("hold-and-soak")
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, wrong), default_configuration())
    assert str(caught.value).startswith(named)


def test_a_probe_interval_longer_than_the_whole_is_malformed():
    with pytest.raises(ParameterError, match="probe_every_s must not be above soak_s, 20 s"):
        parse_parameters(find_kind("hold-and-soak"), {"soak_s": 20.0, "probe_every_s": 30.0})


def test_the_duration_is_about_what_it_takes(held):
    kind = find_kind("hold-and-soak")
    stated_s = kind.duration_s(parse_parameters(kind, CHOSEN), default_configuration())
    taken_s = sum(outcome.cycles for outcome in held.outcomes) * 0.005
    assert 0.5 * taken_s < stated_s < 2.0 * taken_s
