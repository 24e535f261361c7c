"""Speed and acceleration from the last encoder readings."""

import numpy as np
import pytest

from compensator.errors import ModelParameterError
from compensator.local_motion import parabola


def test_a_parabola_is_found_exactly_at_the_middle_of_the_window():
    time_s = np.arange(9) * 0.01
    position_rad = 0.3 + 2.0 * time_s - 2.5 * time_s**2
    found = parabola(9, 0.01).motion(position_rad.tolist())
    assert found.position_rad == pytest.approx(position_rad[4])
    assert found.speed_rad_s == pytest.approx(2.0 - 5.0 * time_s[4])
    assert found.acceleration_rad_s2 == pytest.approx(-5.0)


def test_the_noise_of_counts_is_what_is_stated():
    count_rad, fitted, generator = 1e-4, parabola(20, 0.005), np.random.default_rng(3)
    time_s = np.arange(20) * 0.005
    found = []
    for _ in range(2000):
        smooth_rad = generator.uniform(0, 1) + generator.uniform(0.5, 2.0) * time_s
        found.append(fitted.motion((np.floor(smooth_rad / count_rad) * count_rad).tolist()).acceleration_rad_s2)
    assert np.std(found) == pytest.approx(fitted.acceleration_noise_rad_s2(count_rad), rel=0.1)


@pytest.mark.parametrize(("readings", "period_s"), [(4, 0.01), (10, 0.0)])
def test_windows_that_show_nothing_are_refused(readings, period_s):
    with pytest.raises(ModelParameterError, match="at least 5"):
        parabola(readings, period_s)
