"""Rates of change: the error that theory gives, and what plain differences would have lost."""

from itertools import pairwise

import numpy as np
import pytest

from compensator.lab.recordings.differentiation import rate_of_change, rates_of_change


@pytest.mark.parametrize("turn_rad", [0.2, 0.5, 0.8])
def test_a_sine_loses_what_theory_says(turn_rad):
    """Angular frequency times period: at 0.8 plain differences lose a tenth, these a few thousandths of a percent."""
    rate_hz, k = 100.0, np.arange(400)
    phase = turn_rad * k
    found = rate_of_change(np.sin(phase), rate_hz)[20:-20]
    wanted = turn_rad * rate_hz * np.cos(phase)[20:-20]
    lost = np.abs(found - wanted).max() / np.abs(wanted).max()
    assert lost == pytest.approx(turn_rad**8 / 630.0, rel=0.25)
    plain = np.gradient(np.sin(phase), 1.0 / rate_hz)[20:-20]
    assert np.abs(plain - wanted).max() > 300.0 * np.abs(found - wanted).max()


def test_a_parabola_is_exact_up_to_the_last_samples_and_short_signals_work():
    time_s = 0.01 * np.arange(30)
    found = rate_of_change(3.0 * time_s**2, 100.0)
    assert found[1:-1] == pytest.approx(6.0 * time_s[1:-1])
    assert found[[0, -1]] == pytest.approx([0.03, 6.0 * 0.29 - 0.03])  # half a step off
    assert rate_of_change(np.array([0.0, 1.0, 2.0]), 10.0) == pytest.approx([10.0, 10.0, 10.0])


@pytest.mark.parametrize("counts", [(40, 300, 25), (40, 6, 25)], ids=["all long", "one short"])
def test_trials_side_by_side_have_the_rates_of_each_alone(counts):
    random, rates_hz = np.random.default_rng(4), [200.0, 50.0, 1000.0]
    ends = np.cumsum([0, *counts]).tolist()
    parts = [slice(first, end) for first, end in pairwise(ends)]
    values = random.standard_normal(ends[-1])
    found = rates_of_change(values, parts, rates_hz)
    each = [rate_of_change(values[part], rate_hz) for part, rate_hz in zip(parts, rates_hz, strict=True)]
    assert np.array_equal(found, np.concatenate(each))
