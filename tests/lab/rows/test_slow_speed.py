"""The speed below which a direction is uncertain: that of the sensor's count, whatever the fastest trial looks like."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Plan, recordings

COUNT_RAD = 2.0 * np.pi / 12_000
BENCH = Bench(quantum=COUNT_RAD)
SLOW = Plan("slow", [(1.2, 0.05, 0.0)], load_kg=0.1)
FAST = Plan("fast", [(1.2, 0.9, 0.3)], load_kg=0.1)  # up to eleven counts a sample


def ramp(speed_rad_s):
    """A trial that moves at one speed, in steps of several counts, and never shows a single one."""
    (one,) = recordings(bench=BENCH, trials=[SLOW], seed=3)
    position = COUNT_RAD * np.round(speed_rad_s * one.channels["time_s"] / COUNT_RAD)
    return replace(one, name=f"ramp {speed_rad_s}", channels={**one.channels, "position_rad": position})


def slow_speed(trials, facts=FACTS):
    return make_dataset(trials, facts, Processing(cutoff_hz=6.0)).scales.slow


@pytest.fixture(scope="module")
def slow_and_fast():
    return recordings(bench=BENCH, trials=[SLOW, FAST], seed=3)


def test_a_fast_ramp_does_not_make_slow_motion_uncertain(slow_and_fast):
    dataset = make_dataset([*slow_and_fast, ramp(2.2)], FACTS, Processing(cutoff_hz=6.0))
    slow = dataset.regime[dataset.trial_index == 0]
    assert np.mean(slow == Regime.SLIDING) > 0.7


def test_the_count_that_the_rig_states_is_taken(slow_and_fast):
    told = replace(FACTS, position_count=COUNT_RAD)
    assert slow_speed(slow_and_fast, told) == pytest.approx(slow_speed(slow_and_fast), rel=0.05)
    ramps = [ramp(0.6), ramp(-0.7)]  # these cannot show the count, the rig can
    assert slow_speed(ramps, told) < 0.5 * slow_speed(ramps)
