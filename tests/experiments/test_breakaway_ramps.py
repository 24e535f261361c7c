"""Breakaway ramps on simulated joints: rigid, with bristles, and with static friction that rises at rest."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.config.rig import Arm
from bench.errors import ConfigurationError, LimitError
from bench.experiments.parts.excursion import comparing_cycles, slip_index
from bench.experiments.registry import find_kind, parse_parameters
from tests.experiments.bench_run import Ran
from tests.experiments.plants import bench_with

CHOSEN = {"rates_a_s": (0.2, 1.0), "dwells_s": (0.2,)}
STATIC_A = 0.1  # of preset paper, without load
# bent by 0.02 rad at the motor, 1 mrad at the joint, before they give way
BRISTLE = {"stiffness_n_m_rad": 0.25, "damping_n_m_s_rad": 2e-3}


@pytest.fixture(scope="module")
def rigid():
    return Ran(default_configuration(), "breakaway-ramps", **CHOSEN)


@pytest.fixture(scope="module")
def bristly():
    return Ran(bench_with(bristle=BRISTLE), "breakaway-ramps", **CHOSEN)


def test_every_ramp_slips_both_ways_and_every_trial_ends_at_angle_0(rigid):
    assert rigid.summary["breakaways"] == 4
    assert rigid.summary["without_slip"] == 0
    for trial, outcome in enumerate(rigid.outcomes):
        assert outcome.outcome == "completed"
        assert [one["direction"] for one in outcome.results["breakaways"]] == [1, -1]
        assert abs(rigid.channel(trial, "position_rad")[-1]) < 0.01


def test_the_first_motion_comes_at_the_static_friction_of_the_plant(rigid):
    for row in rigid.summary["rows"]:
        # 1.5 % of scatter, and what the ramp rises while the joint makes its first counts
        late_a = row["rate_a_s"] * 0.06
        assert 0.95 * STATIC_A < row["direction"] * row["onset_current_a"] < 1.05 * STATIC_A + late_a
        assert abs(row["current_a"]) >= abs(row["onset_current_a"])


def test_dwell_ramp_and_slip_are_events_in_that_order(rigid):
    details = [detail.split()[0] for _, name, detail in rigid.events[0] if name == "breakaway"]
    assert details == ["dwell", "ramp", "slip"] * 2


def test_the_joint_stood_for_the_dwell_at_least():
    ran = Ran(default_configuration(), "breakaway-ramps", rates_a_s=(1.0,), dwells_s=(0.0, 1.0))
    short, long = (row for row in ran.summary["rows"] if row["direction"] == 1)
    assert long["stood_s"] - short["stood_s"] == pytest.approx(1.0, abs=0.011)
    assert short["stood_s"] >= 0.1


def test_bristles_give_way_before_they_slip(rigid, bristly):
    for stiff, soft in zip(rigid.summary["rows"], bristly.summary["rows"], strict=True):
        # the first counts come long before the static friction is reached: half of it bends them by half a mrad
        assert abs(soft["onset_current_a"]) < 0.5 * STATIC_A < abs(stiff["onset_current_a"])
        assert soft["travel_before_slip_rad"] > 0.0005


def test_bristles_that_creep_break_away_earlier_on_slow_ramps(bristly):
    slow, fast = (
        np.mean([abs(row["current_a"]) for row in bristly.summary["rows"] if row["rate_a_s"] == rate])
        for rate in CHOSEN["rates_a_s"]
    )
    assert slow < fast


def test_breakaway_rises_with_the_dwell_as_the_plants_does():
    ageing = bench_with(dwell={"rise_fraction": 0.6, "time_s": 1.0}, scatter={"static_fraction": 0.0})
    ran = Ran(ageing, "breakaway-ramps", rates_a_s=(0.5,), dwells_s=(0.2, 5.0))
    young, old = (
        np.mean([abs(row["onset_current_a"]) for row in ran.summary["rows"] if row["dwell_s"] == dwell_s])
        for dwell_s in (0.2, 5.0)
    )
    # (1 + r t / (t + t0)) after 0.7 s (dwell, easing, settling, ramp) and after 5.5 s
    expected = (1.0 + 0.6 * 5.5 / 6.5) / (1.0 + 0.6 * 0.7 / 1.7)
    assert old / young == pytest.approx(expected, rel=0.06)


def test_at_90_degrees_the_ramps_start_from_what_holds_the_load():
    ran = Ran(
        default_configuration(), "breakaway-ramps", angle_rad=1.57, load_kg=0.1, rates_a_s=(0.5,), dwells_s=(0.2,)
    )
    up, down = (row["current_a"] for row in ran.summary["rows"])
    # 100 g take 0.49 A; friction on either side of it
    assert down + 0.2 < 0.49 < up - 0.2


def test_a_ramp_that_reaches_the_ceiling_is_given_up():
    plain = default_configuration()
    low = plain.model_copy(update={"search": plain.search.model_copy(update={"ceiling_a": 0.08})})
    ran = Ran(low, "breakaway-ramps", rates_a_s=(0.5,), dwells_s=(0.0,))
    assert ran.outcomes[0].outcome == "completed"
    assert ran.summary == {"rows": ran.summary["rows"], "breakaways": 0, "without_slip": 2}
    assert all(row["current_a"] is None for row in ran.summary["rows"])


def test_slip_by_hand():
    # creeps by 1, then runs: 2, 4, 8 ... in units of 0.01 rad and cycles of 0.1 s
    way_rad = np.array([0.0, 0.0, 0.01, 0.02, 0.06, 0.14, 0.3])
    assert slip_index(way_rad, slip_speed_rad_s=0.2, period_s=0.1, count_rad=1e-6) == 3
    assert slip_index(way_rad[3:], slip_speed_rad_s=0.2, period_s=0.1, count_rad=1e-6) == 0
    # fast cycles of a coarse encoder: 3 counts of 1e-4 rad at 0.05 rad/s take 6 ms
    assert comparing_cycles(0.05, 0.001, 1e-4) == 6
    assert comparing_cycles(0.05, 0.1, 1e-4) == 1


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"load_kg": 0.2}, "load_kg is 0.2 kg"),
        ({"angle_rad": 2.1}, "angle_rad is 2.1 rad"),
        ({"rates_a_s": (20.0,)}, "a rate of rates_a_s is 20 A/s; allowed is at most 15"),
        ({"excursion_rad": 0.015}, "excursion_rad is 0.015 rad; allowed is at least 0.02"),
    ],
)
def test_what_the_bench_must_not_do_is_refused(wrong, named):
    kind = find_kind("breakaway-ramps")
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, wrong), default_configuration())
    assert str(caught.value).startswith(named)


def test_a_rig_that_does_not_tell_what_holds_the_load_stands_at_angle_0_only():
    plain = default_configuration()
    short = plain.model_copy(update={"rig": plain.rig.model_copy(update={"arm": Arm()})})
    kind = find_kind("breakaway-ramps")
    kind.refuse(parse_parameters(kind, {}), short)
    with pytest.raises(ConfigurationError, match=r"arm\.length_m"):
        kind.refuse(parse_parameters(kind, {"angle_rad": 1.0}), short)


def test_the_duration_is_about_what_it_takes(rigid):
    kind = find_kind("breakaway-ramps")
    stated_s = kind.duration_s(parse_parameters(kind, CHOSEN), default_configuration())
    taken_s = sum(outcome.cycles for outcome in rigid.outcomes) * 0.005
    assert 0.5 * taken_s < stated_s < 2.0 * taken_s
