"""Strokes there and back on the simulated bench of the paper, and on joints with bristles."""

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.errors import LimitError
from bench.experiments.registry import find_kind, parse_parameters
from tests.experiments.bench_run import Ran
from tests.experiments.plants import bench_with

CHOSEN = {"amplitudes_rad": (0.3, 0.02, 0.002), "strokes": 4}


@pytest.fixture(scope="module")
def ran():
    return Ran(default_configuration(), "reversals", **CHOSEN)


def test_the_joint_goes_from_end_to_end_and_ends_at_angle_0(ran):
    for trial, (outcome, amplitude_rad) in enumerate(zip(ran.outcomes, CHOSEN["amplitudes_rad"], strict=True)):
        assert outcome.outcome == "completed"
        assert outcome.results["strokes"] == 4
        assert outcome.results["reached_rad"] == pytest.approx(amplitude_rad, rel=0.15)
        assert abs(ran.channel(trial, "position_rad")[-1]) < 0.01


def test_every_reversal_is_an_event(ran):
    marked = [detail for _, name, detail in ran.events[0] if name == "reversal"]
    assert marked == ["towards -0.3 rad", "towards 0.3 rad"] * 2 + ["towards -0.3 rad", "towards 0 rad"]


def test_the_friction_of_large_strokes_is_that_of_the_plant(ran):
    # at 0.6 rad/s the motor turns 12 rad/s: Coulomb 60 mA, viscous 25 mA, arm side 6.6 mA; half the load is none
    assert ran.outcomes[0].results["friction_current_a"] == pytest.approx(0.092, rel=0.1)
    assert abs(ran.outcomes[0].results["load_current_a"]) < 0.005


def test_strokes_within_the_free_play_move_the_motor_alone(ran):
    # 0.002 rad of 0.01 rad: the arm's friction, and its inertia, are not felt
    assert ran.outcomes[2].results["friction_current_a"] < ran.outcomes[1].results["friction_current_a"]


def test_strokes_within_the_pre_sliding_need_less_than_the_static_friction():
    # bent by 10 mrad at the joint before they give way: strokes of 2 mrad are springs
    soft = bench_with(bristle={"stiffness_n_m_rad": 0.025, "damping_n_m_s_rad": 2e-3})
    ran = Ran(soft, "reversals", amplitudes_rad=(0.001,), strokes=4)
    current_a = ran.channel(0, "current_estimate_a")
    position_rad = ran.channel(0, "position_rad")
    moving = np.abs(ran.channel(0, "target_rad")) > 0.0008
    assert np.max(np.abs(position_rad[moving])) < 0.002
    assert np.max(np.abs(current_a[moving])) < 0.07  # of 0.1 A that the joint breaks away at


def test_the_servo_has_its_dead_band_again_afterwards(ran):
    # with the tight one the joint would hunt at the end
    assert np.ptp(ran.channel(2, "position_rad")[-15:]) < 1e-3


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"load_kg": 0.2}, "load_kg is 0.2 kg"),
        ({"angle_rad": 1.8}, "angle_rad and an amplitude of amplitudes_rad is 2.3 rad"),
        ({"amplitudes_rad": (1e-5,)}, "an amplitude of amplitudes_rad is 1e-05 rad; allowed is at least 0.00023"),
        ({"speed_rad_s": 9.0}, "speed_rad_s is 9 rad/s"),
    ],
)
def test_what_the_bench_must_not_do_is_refused(wrong, named):
    kind = find_kind("reversals")
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, wrong), default_configuration())
    assert str(caught.value).startswith(named)


def test_the_duration_is_about_what_it_takes(ran):
    kind = find_kind("reversals")
    stated_s = kind.duration_s(parse_parameters(kind, CHOSEN), default_configuration())
    taken_s = sum(outcome.cycles for outcome in ran.outcomes) * 0.005
    assert 0.5 * taken_s < stated_s < 2.0 * taken_s
