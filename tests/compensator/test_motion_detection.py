"""Motion told from encoder noise, at a stated rate of false alarms."""

import numpy as np
import pytest

from compensator.errors import ModelParameterError
from compensator.rest.motion_detection import false_alarms_per_hour, threshold_counts

PERIOD_S = 0.005
HOUR = 3600.0 / PERIOD_S


@pytest.mark.parametrize("noise", [0.4, 1.0, 3.0])
def test_no_more_false_alarms_than_stated_wherever_the_joint_stands(noise):
    # a rate high enough to be counted: 1 % of the readings
    counts = threshold_counts(noise, 0.01 * HOUR, PERIOD_S)
    generator, worst = np.random.default_rng(7), 0.0
    for place in np.arange(0.0, 1.0, 0.1):
        readings = np.floor(place + noise * generator.standard_normal((2, 40_000)))
        worst = max(worst, np.mean(np.abs(readings[1] - readings[0]) >= counts))
    assert worst <= 0.01 * 1.15  # 400 alarms expected at most: within three standard deviations
    if noise > 1.0:
        assert worst >= 0.002  # and the statement is not empty


def test_half_the_counts_would_break_the_statement():
    # so the test above can fail
    counts = threshold_counts(1.0, 0.01 * HOUR, PERIOD_S) / 2.0
    readings = np.floor(0.5 + np.random.default_rng(7).standard_normal((2, 40_000)))
    assert np.mean(np.abs(readings[1] - readings[0]) >= counts) > 0.02


def test_without_noise_two_counts_are_motion():
    assert threshold_counts(0.0, 1e-6, PERIOD_S) == 2.0
    assert false_alarms_per_hour(0.0, 2.0, PERIOD_S) == 0.0


def test_the_rate_of_a_threshold_is_the_one_it_was_made_for():
    assert false_alarms_per_hour(0.8, threshold_counts(0.8, 1.0, PERIOD_S), PERIOD_S) == pytest.approx(1.0)


@pytest.mark.parametrize(("noise", "rate"), [(-0.1, 1.0), (float("nan"), 1.0), (0.5, 0.0), (0.5, HOUR)])
def test_what_means_nothing_is_refused(noise, rate):
    with pytest.raises(ModelParameterError, match="allowed"):
        threshold_counts(noise, rate, PERIOD_S)
