"""From a recording to signals: derivatives, gaps, saturation, irregular time."""

import numpy as np
import pytest

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.processing import (
    DIFFERENTIATION_FACTOR,
    FILTER_ORDER,
    distance_to_nearest,
    make_signals,
)
from compensator.lab.recordings.recording import Recording

CUTOFF_HZ = 8.0


def recording(time_s: np.ndarray, **channels: np.ndarray) -> Recording:
    position = 0.5 * np.sin(2 * np.pi * time_s)
    return Recording(
        "swing", "sine", {}, {"time_s": time_s, "position_rad": position, "torque_n_m": np.cos(time_s), **channels}
    )


def signals_of(made: Recording, cutoff_hz: float = CUTOFF_HZ):
    return make_signals(made, choose_effort([made], Facts()), Facts(), cutoff_hz)


def wide_gain(frequency_hz: float, cutoff_hz: float) -> float:
    """Of a Butterworth filter run forth and back."""
    return 1.0 / (1.0 + (frequency_hz / (DIFFERENTIATION_FACTOR * cutoff_hz)) ** (2 * FILTER_ORDER))


def test_derivatives_of_a_sine():
    time_s = np.arange(0, 6, 1 / 200)
    found = signals_of(recording(time_s))
    w = 2 * np.pi
    gain = wide_gain(1.0, CUTOFF_HZ)
    rows = found.usable
    expected = 0.5 * gain * np.array([w * np.cos(w * time_s), -(w**2) * np.sin(w * time_s)])
    assert np.abs(found.velocity - expected[0])[rows].max() < 1e-4 * 0.5 * w
    assert np.abs(found.acceleration - expected[1])[rows].max() < 1e-4 * 0.5 * w**2
    assert np.abs(found.jerk + 0.5 * w**3 * np.cos(w * time_s))[rows].max() < 1e-3 * 0.5 * w**3
    assert found.rate_hz == pytest.approx(200)


def test_ends_and_what_is_near_a_lost_sample_are_left_out():
    time_s = np.arange(0, 10, 1 / 200)
    torque = np.cos(time_s)
    torque[1000] = np.nan
    usable = signals_of(recording(time_s, torque_n_m=torque)).usable
    assert not usable[time_s < 3 / CUTOFF_HZ - 1e-9].any()
    assert not usable[time_s > time_s[-1] - 3 / CUTOFF_HZ + 1e-9].any()
    near = np.abs(time_s - 5.0) <= 2 / CUTOFF_HZ
    assert not usable[near].any()
    inside = (time_s > 1) & (time_s < 9)
    assert usable[inside & ~(np.abs(time_s - 5.0) <= 2.01 / CUTOFF_HZ)].all()


@pytest.mark.parametrize(
    ("channel", "value"), [("enabled", 0.0), ("duty", 0.98), ("duty", -1.0), ("position_rad", np.nan)]
)
def test_open_loop_and_saturated_samples_are_left_out(channel, value):
    time_s = np.arange(0, 10, 1 / 200)
    values = {"enabled": np.ones(2000), "duty": np.full(2000, 0.3), "position_rad": 0.5 * np.sin(2 * np.pi * time_s)}
    values[channel][900:1100] = value
    usable = signals_of(recording(time_s, **values)).usable
    assert not usable[880:1120].any()
    assert usable[300:850].all()
    assert usable[1150:1800].all()


def test_both_sides_of_a_gap_are_left_out():
    time_s = np.delete(np.arange(0, 10, 1 / 200), slice(1000, 1040))
    found = signals_of(recording(time_s))
    inside = (found.time_s > 4.76) & (found.time_s < 5.44)
    assert inside.sum() > 80
    assert not found.usable[inside].any()
    assert found.usable[(found.time_s > 1) & (found.time_s < 4.74)].all()
    assert found.usable[(found.time_s > 5.46) & (found.time_s < 9)].all()


def test_the_middle_of_a_long_gap_is_left_out():
    time_s = np.delete(np.arange(0, 10, 1 / 200), slice(800, 1200))
    found = signals_of(recording(time_s))
    assert not found.usable[(found.time_s > 3.76) & (found.time_s < 6.24)].any()
    assert found.usable[(found.time_s > 6.26) & (found.time_s < 9)].all()


def test_irregular_time_is_made_uniform_and_regular_time_is_left_alone():
    random = np.random.default_rng(1)
    regular = np.arange(0, 6, 1 / 200)
    assert signals_of(recording(regular)).time_s is regular
    jittered = regular + random.uniform(-0.3, 0.3, len(regular)) / 200
    found = signals_of(recording(np.sort(jittered)))
    assert np.ptp(np.diff(found.time_s)) < 1e-9
    rows = found.usable
    assert np.abs(found.position - 0.5 * np.sin(2 * np.pi * found.time_s))[rows].max() < 1e-3


def test_too_short_says_how_long_is_enough():
    with pytest.raises(UnusableDataError, match=r"'swing' has 20 samples; at least \d+ are needed.*8 Hz; record"):
        signals_of(recording(np.arange(20) / 200))


def test_no_position_says_what_was_found():
    time_s = np.arange(0, 6, 1 / 200)
    made = recording(time_s)
    linear = Facts(joint="linear")
    with pytest.raises(UnusableDataError, match=r"'swing'.*position_m is missing.*position_rad, time_s.*linear joint"):
        make_signals(made, choose_effort([made], Facts()), linear, CUTOFF_HZ)


def test_distance_to_the_nearest_mark():
    assert distance_to_nearest(np.array([0.0, 1.0, 2.6, 9.0]), np.array([1.0, 3.0])) == pytest.approx([1, 0, 0.4, 6])
    assert np.isinf(distance_to_nearest(np.zeros(2), np.empty(0))).all()


def test_a_drive_that_is_polled_and_answers_by_twos_leaves_no_gaps():
    """Steps of 1 and 14 ms alternate: half of the steps are long, and nearly all of the time passes in them."""
    steps = np.tile([0.001, 0.014], 700)
    for extra in ([], [0.001]):  # the median of the steps would be the one or the other
        time_s = np.concatenate([[0.0], np.cumsum([*steps, *extra])])
        found = signals_of(recording(time_s), 4.0)
        inside = (found.time_s > 1.0) & (found.time_s < time_s[-1] - 1.0)
        assert found.usable[inside].all()
        assert found.rate_hz == pytest.approx(1 / 0.014)


def test_a_gap_between_regular_samples_is_still_one():
    time_s = np.arange(0, 10, 1 / 200)
    time_s[1000:] += 0.2
    found = signals_of(recording(time_s))
    assert not found.usable[(found.time_s > 5.0) & (found.time_s < 5.19)].any()
