"""The coast-down on simulated joints whose friction and inertia are known."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.errors import LimitError
from bench.experiments.analysis.coast_fit import fit_coast
from bench.experiments.registry import find_kind, parse_parameters
from tests.experiments.bench_run import Ran
from tests.experiments.plants import bench_with, dry_plant

INERTIA_KG_M2 = 3e-5 * 20.0**2 + 0.01  # of preset paper: rotor through the gear, and arm
SPEEDS = {"speeds_rad_s": (2.0, 4.0)}


@pytest.fixture(scope="module")
def paper():
    return Ran(default_configuration(), "coast-down", **SPEEDS)


def test_every_coast_comes_to_rest_and_ends_at_angle_0(paper):
    assert [outcome.outcome for outcome in paper.outcomes] == ["completed"] * 4
    for trial, row in enumerate(paper.summary["rows"]):
        assert row["came_to_rest"]
        asked_rad_s = paper.plans[trial].conditions["released_speed_rad_s"]
        assert row["released_speed_rad_s"] == pytest.approx(asked_rad_s, rel=0.15)
        assert abs(paper.channel(trial, "position_rad")[-1]) < 0.01


def test_while_it_coasts_no_current_is_asked_for(paper):
    command_a = paper.channel(0, "current_command_a")
    asked = (command_a == 0.0) & (paper.channel(0, "velocity_rad_s") > 0.1)
    assert np.count_nonzero(asked) > 20
    assert [detail for _, name, detail in paper.events[0] if name == "coast"] == ["released"]


def test_both_directions_slow_down_alike(paper):
    ways_rad = {(row["direction"], round(row["released_speed_rad_s"])): row["way_rad"] for row in paper.summary["rows"]}
    for speed in (2, 4):
        assert ways_rad["forward", speed] == pytest.approx(ways_rad["backward", speed], rel=0.1)


@pytest.mark.parametrize("released", ["current", "off"])
def test_the_time_constant_is_inertia_over_viscous_friction(released):
    # 1.1e-4 N m s/rad on the motor's shaft are 0.044 at the joint: 0.5 s
    ran = Ran(bench_with(**dry_plant(3e-4, 1.1e-4)), "coast-down", released=released, **SPEEDS)
    for row in ran.summary["rows"]:
        assert row["time_constant_s"] == pytest.approx(INERTIA_KG_M2 / (1.1e-4 * 400.0), rel=0.03)
        assert row["dry_deceleration_rad_s2"] == pytest.approx(3e-4 * 20.0 / INERTIA_KG_M2, rel=0.3)


def test_dry_friction_alone_slows_down_evenly():
    ran = Ran(bench_with(**dry_plant(3e-3, 0.0)), "coast-down", released="off", **SPEEDS)
    for row in ran.summary["rows"]:
        expected = 3e-3 * 20.0 / INERTIA_KG_M2
        assert row["dry_deceleration_rad_s2"] == pytest.approx(expected, rel=0.03)
        assert row["time_constant_s"] is None or row["time_constant_s"] > 20.0


def test_a_joint_that_hardly_slows_down_is_braked_before_the_end_of_its_travel():
    ran = Ran(bench_with(**dry_plant(3e-4, 1e-6)), "coast-down", **SPEEDS)
    for trial, row in enumerate(ran.summary["rows"]):
        assert ran.outcomes[trial].outcome == "completed"
        assert not row["came_to_rest"]
        assert np.max(np.abs(ran.channel(trial, "position_rad"))) < 2.2


def test_the_longest_coast_is_kept():
    ran = Ran(bench_with(**dry_plant(3e-4, 1e-6)), "coast-down", speeds_rad_s=(0.5,), coast_s=0.5)
    for row in ran.summary["rows"]:
        assert row["coast_s"] == pytest.approx(0.5, abs=0.02)
        assert not row["came_to_rest"]


def test_the_fit_by_hand():
    # v = (v0 + a T) exp(-t / T) - a T, with a = 2 rad/s2, T = 0.5 s, v0 = 3 rad/s
    time_s = np.arange(0.0, 0.5, 0.005)
    way_rad = 0.5 * 4.0 * (1.0 - np.exp(-time_s / 0.5)) - 1.0 * time_s
    found = fit_coast(time_s, way_rad)
    assert found.dry_deceleration_rad_s2 == pytest.approx(2.0, rel=1e-3)
    assert found.time_constant_s == pytest.approx(0.5, rel=1e-3)
    assert found.readings < len(time_s)


def test_a_reading_that_is_told_again_changes_nothing():
    time_s = np.arange(0.0, 0.5, 0.01)
    way_rad = 2.0 * time_s - 1.5 * time_s**2
    again = np.repeat(np.arange(len(time_s)), np.where(np.arange(len(time_s)) % 7 == 0, 2, 1))
    assert fit_coast(time_s[again], way_rad[again]) == fit_coast(time_s, way_rad)


def test_too_few_readings_tell_nothing():
    found = fit_coast(np.array([0.0, 0.005]), np.array([0.0, 0.01]))
    assert np.isnan(found.time_constant_s)
    assert np.isnan(found.dry_deceleration_rad_s2)


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"load_kg": 0.2}, "load_kg is 0.2 kg"),
        ({"speeds_rad_s": (7.0,)}, "a speed of speeds_rad_s and a fifth is 8.4 rad/s"),
        ({"speeds_rad_s": (6.0,), "acceleration_rad_s2": 5.0}, "a speed of speeds_rad_s is 6 rad/s"),
    ],
)
def test_what_the_bench_must_not_do_is_refused(wrong, named):
    kind = find_kind("coast-down")
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, wrong), default_configuration())
    assert str(caught.value).startswith(named)


def test_the_duration_is_about_what_it_takes(paper):
    kind = find_kind("coast-down")
    stated_s = kind.duration_s(parse_parameters(kind, SPEEDS), default_configuration())
    taken_s = sum(outcome.cycles for outcome in paper.outcomes) * 0.005
    assert 0.5 * taken_s < stated_s < 2.0 * taken_s
