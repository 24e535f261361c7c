"""Speed and acceleration from the last encoder readings, and the averages that go with them."""

import numpy as np
import pytest

from compensator.errors import ModelParameterError
from compensator.motion.local_motion import window

PERIOD_S = 0.01


def test_a_parabola_has_its_acceleration_and_its_speed_at_the_middle():
    time_s = np.arange(9) * PERIOD_S
    found = window(9, PERIOD_S).motion((0.3 + 2.0 * time_s - 2.5 * time_s**2).tolist())
    assert found.speed_rad_s == pytest.approx(2.0 - 5.0 * time_s[4])
    assert found.acceleration_rad_s2 == pytest.approx(-5.0)


def test_what_is_constant_averages_to_itself():
    nine = window(9, PERIOD_S)
    assert nine.mean([0.7] * 9) == pytest.approx(0.7)
    assert nine.mean_held([0.7] * 9) == pytest.approx(0.7)
    assert nine.motion([0.7] * 9) == pytest.approx((0.7, 0.0, 0.0), abs=1e-10)


@pytest.mark.parametrize("frequency_hz", [1.0, 6.0, 13.0, 40.0])
def test_current_and_acceleration_are_averaged_alike_however_the_motion_swings(frequency_hz):
    # a body under a current held for each period: a = I / J, integrated exactly
    inertia, twenty = 0.05, window(20, PERIOD_S)
    current_a = np.sin(2.0 * np.pi * frequency_hz * np.arange(21) * PERIOD_S)
    speed = np.concatenate([[0.3], 0.3 + np.cumsum(current_a[1:]) / inertia * PERIOD_S])
    position_rad = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2.0 * PERIOD_S)])
    found = twenty.motion(position_rad[1:].tolist())
    assert inertia * found.acceleration_rad_s2 == pytest.approx(twenty.mean_held(current_a[1:].tolist()), abs=1e-9)


def test_the_noise_of_counts_is_what_is_stated():
    count_rad, fitted, generator = 1e-4, window(20, 0.005), np.random.default_rng(3)
    time_s = np.arange(20) * 0.005
    found = []
    for _ in range(2000):
        smooth_rad = generator.uniform(0, 1) + generator.uniform(0.5, 2.0) * time_s
        found.append(fitted.motion((np.floor(smooth_rad / count_rad) * count_rad).tolist()).acceleration_rad_s2)
    assert np.std(found) == pytest.approx(fitted.acceleration_noise_rad_s2(count_rad), rel=0.1)


@pytest.mark.parametrize(("readings", "period_s"), [(4, 0.01), (10, 0.0)])
def test_windows_that_show_nothing_are_refused(readings, period_s):
    with pytest.raises(ModelParameterError, match="at least 5"):
        window(readings, period_s)
