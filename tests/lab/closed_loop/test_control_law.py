"""The servo's gains, from what it did."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.closed_loop.control_law import ControlLaw, law_of, stand_in, target_of
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.processing import Signals, make_signals
from compensator.lab.recordings.recording import Recording
from tests.lab.closed_loop.servoed import FACTS, Joint, run

CUTOFF_HZ = 10.0


def signals(channels) -> Signals:
    recording = Recording("one", "sines", {}, channels)
    return make_signals(recording, choose_effort([recording], FACTS), FACTS, CUTOFF_HZ)


def found(channels, told=None) -> ControlLaw:
    made = signals(channels)
    return law_of(made, target_of(made, FACTS), CUTOFF_HZ, 0.05, told)


@pytest.mark.parametrize("joint", [Joint(), Joint(stiffness=15.0, damping=0.4), Joint(integral=60.0)])
def test_gains_are_those_of_the_servo(joint):
    law = found(run(joint))
    assert law.source == "recording"
    assert law.stiffness == pytest.approx(joint.stiffness, rel=0.05)
    assert law.damping == pytest.approx(joint.damping, rel=0.1)
    assert law.integral == pytest.approx(joint.integral, rel=0.1, abs=2.0)


def test_feed_forward_and_a_constant_change_no_gain():
    channels = run(Joint())
    added = channels["torque_n_m"] + 0.7 + 0.4 * np.gradient(channels["target_rad"], channels["time_s"])
    law = found({**channels, "torque_n_m": added})
    assert law.stiffness == pytest.approx(40.0, rel=0.05)
    assert law.damping == pytest.approx(1.5, rel=0.1)


def test_without_a_set_point_a_servo_stands_in():
    channels = run(Joint())
    del channels["target_rad"]
    assert found(channels) == stand_in(CUTOFF_HZ, 0.05)
    assert found(channels, ControlLaw(1.0, 0.0, 0.0, "bench")).source == "stand-in"


def test_a_set_point_with_holes_is_none():
    channels = run(Joint())
    target = channels["target_rad"].copy()
    target[500:600] = np.nan
    assert found({**channels, "target_rad": target}).source == "stand-in"
    target = channels["target_rad"].copy()
    target[:3] = np.nan  # before anything counts
    assert found({**channels, "target_rad": target}).source == "recording"


def test_an_effort_that_no_law_explains_is_not_forced_into_one():
    channels = run(Joint())
    noise = np.random.default_rng(1).normal(size=len(channels["time_s"])).cumsum()
    assert found({**channels, "torque_n_m": noise}).source == "stand-in"


def test_a_law_that_explains_only_half_is_none():
    channels = run(Joint())
    torque_n_m, random = channels["torque_n_m"], np.random.default_rng(3)
    slow = np.convolve(random.normal(size=len(torque_n_m)), np.ones(50), "same")
    added = torque_n_m + np.std(torque_n_m) / np.std(slow) * slow
    assert found({**channels, "torque_n_m": added}).source == "stand-in"


def test_what_the_bench_says_goes_before():
    told = ControlLaw(39.0, 0.0, 1.4, "bench", 0.004)
    assert found(run(Joint()), told) == told


def test_a_stand_in_is_as_quick_as_half_the_cut_off():
    law = stand_in(CUTOFF_HZ, 0.05)
    assert np.sqrt(law.stiffness / 0.05) == pytest.approx(2.0 * np.pi * 5.0)
    assert law.damping / (2.0 * np.sqrt(law.stiffness * 0.05)) == pytest.approx(0.7)
    assert replace(law, source="bench") != law
