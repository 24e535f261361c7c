"""Profiles and waveforms keep to their bounds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench.experiments.parts.profile import Trapezoid
from bench.experiments.parts.waveforms import WAVEFORMS, sampled


def test_a_long_move_by_hand():
    # 1 m/s2-like numbers: up in 1 s (0.5 rad), cruise 1 s at 1 rad/s, down in 1 s
    move = Trapezoid(0.0, 2.0, speed_rad_s=1.0, acceleration_rad_s2=1.0)
    assert move.duration_s == pytest.approx(3.0)
    assert move.at(1.0) == pytest.approx((0.5, 1.0))
    assert move.at(1.5) == pytest.approx((1.0, 1.0))
    assert move.at(2.5) == pytest.approx((1.875, 0.5))
    assert move.at(9.0) == (2.0, 0.0)


def test_no_way_takes_no_time():
    move = Trapezoid(0.3, 0.3, 1.0, 1.0)
    assert move.duration_s == 0.0
    assert move.at(0.0) == (0.3, 0.0)


angles = st.floats(-3.0, 3.0)


@given(angles, angles, st.floats(0.1, 10.0), st.floats(0.5, 200.0))
def test_moves_keep_to_speed_and_acceleration(start, end, speed, acceleration):
    move = Trapezoid(start, end, speed, acceleration)
    times = np.linspace(0.0, move.duration_s, 301)
    points = np.array([move.at(float(time)) for time in times])
    assert points[0] == pytest.approx((start, 0.0), abs=1e-6)
    assert points[-1] == pytest.approx((end, 0.0), abs=1e-9)
    assert np.max(np.abs(points[:, 1])) <= speed * (1 + 1e-9)
    step_s = times[1] - times[0]
    assert np.max(np.abs(np.diff(points[:, 1]))) <= acceleration * step_s * (1 + 1e-6) + 1e-9
    np.testing.assert_allclose(np.diff(points[:, 0]), points[:-1, 1] * step_s, atol=acceleration * step_s**2 + 1e-9)


@pytest.mark.parametrize("name", WAVEFORMS)
@pytest.mark.parametrize("duration_s", [2.0, 8.0, 30.0])
def test_waveforms_keep_to_amplitude_and_speed_and_begin_and_end_at_rest(name, duration_s):
    points = sampled(name, duration_s, 0.005, amplitude_rad=1.5, speed_rad_s=3.0)
    assert points.shape == (round(duration_s / 0.005), 2)
    assert np.max(np.abs(points[:, 0])) <= 1.5 * (1 + 1e-12)
    assert np.max(np.abs(points[:, 1])) <= 3.0 * (1 + 1e-12)
    assert np.abs(points[[0, -1]]).max() < 0.05
    np.testing.assert_allclose(np.gradient(points[:, 0], 0.005), points[:, 1], atol=1e-9)
