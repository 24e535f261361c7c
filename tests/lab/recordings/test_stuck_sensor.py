"""A position that stands still: the sensor is stuck where speed or a leap says so, and at rest where nothing does."""

import re

import numpy as np
import pytest

from compensator.lab.recordings.recording import Recording
from compensator.lab.recordings.stuck_sensor import _lag_s, stuck_positions
from tests.lab.synthetic import FACTS

RATE_HZ = 200.0
TIME_S = np.arange(0.0, 10.0, 1.0 / RATE_HZ)
QUANTUM = 1e-4
SWING = np.sin(2.0 * np.pi * 0.3 * TIME_S)
SPEED = 2.0 * np.pi * 0.3 * np.cos(2.0 * np.pi * 0.3 * TIME_S)


def recording(position: np.ndarray, speed: np.ndarray | None = None) -> Recording:
    channels = {"time_s": TIME_S, "position_rad": QUANTUM * np.round(position / QUANTUM)}
    return Recording("one", "x", {}, channels if speed is None else {**channels, "velocity_rad_s": speed})


def held(values: np.ndarray, start_s: float, end_s: float) -> np.ndarray:
    within = (start_s <= TIME_S) & (end_s >= TIME_S)
    return np.where(within, values[np.argmax(within)], values)


def with_rests(rest_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Moves of one second, each from rest to rest, and what the joint does between them."""
    within = np.mod(TIME_S, 1.0 + rest_s)
    count = np.floor(TIME_S / (1.0 + rest_s))
    part = np.minimum(within, 1.0)
    position = count + part - np.sin(2.0 * np.pi * part) / (2.0 * np.pi)
    return position, np.where(within < 1.0, 1.0 - np.cos(2.0 * np.pi * part), 0.0)


@pytest.mark.parametrize("until_s", [6.0, 10.0], ids=["for a while", "for good"])
def test_a_speed_that_goes_on_tells_where_the_position_is_stuck(until_s):
    (told,) = stuck_positions([recording(held(SWING, 4.0, until_s), SPEED)], FACTS)
    assert re.search(rf"'one': position_rad stands still from 4 to {min(until_s, TIME_S[-1]):.4g} s", told)
    assert re.search(
        r"velocity_rad_s covers .* rad meanwhile: the sensor is stuck; leave the trial out, or leave", told
    )


def test_without_a_speed_a_leap_tells_it():
    (told,) = stuck_positions([recording(held(SWING, 4.0, 5.0))], FACTS)
    assert re.search("from 4 to 5 s, though it goes on with a leap of -?[01].", told)


def test_one_sentence_names_all_trials():
    one = recording(held(SWING, 4.0, 6.0), SPEED)
    (told,) = stuck_positions([one, recording(SWING, SPEED), Recording("other", "x", {}, one.channels)], FACTS)
    assert "(and so in 'other')" in told


def late(speed: np.ndarray) -> np.ndarray:
    return np.roll(speed, round(0.08 * RATE_HZ))


def filtered(speed: np.ndarray, lag_s: float) -> np.ndarray:
    """The speed as a drive's filter of first order gives it."""
    share, value, found = 1.0 / (RATE_HZ * lag_s), speed[0], []
    for one in speed:
        value += share * (one - value)
        found.append(value)
    return np.array(found)


AT_STOP = np.minimum(SWING, 0.3)  # which the joint runs into at speed
FADING = filtered(np.gradient(AT_STOP, TIME_S), 0.3)


def test_behind_a_filter_a_stuck_sensor_is_told_all_the_same():
    assert stuck_positions([recording(held(SWING, 4.0, 6.0), filtered(SPEED, 0.3))], FACTS)


def stick_slip() -> np.ndarray:
    """A joint that breaks away once in a second, by more than it moves otherwise, and springs back a little."""
    slip = QUANTUM * 20.0 * np.floor(TIME_S)
    return slip + QUANTUM * np.round(np.cos(2.0 * np.pi * 20.0 * TIME_S)) * (np.mod(TIME_S, 1.0) < 0.5)


def filled_up(position: np.ndarray) -> np.ndarray:
    """Samples that were lost, three in a row, and stand for as long as the last one before."""
    return position[np.arange(len(position)) // 4 * 4]


@pytest.mark.parametrize(
    "made",
    [
        recording(SWING, SPEED),
        recording(SWING),
        recording(*with_rests(1.5)),
        recording(with_rests(1.5)[0]),
        recording(with_rests(0.3)[0], late(with_rests(0.3)[1])),
        recording(with_rests(3.0)[0], with_rests(3.0)[1] + 0.1),
        recording(AT_STOP, FADING),
        recording(filled_up(SWING), SPEED),
        recording(np.round(SWING / 0.05) * 0.05, SPEED),
        recording(0.0 * SWING, 1e-3 * np.random.default_rng(0).standard_normal(len(SWING))),
        recording(np.where(np.arange(len(SWING)) % 400 < 200, np.nan, SWING), SPEED),
        recording(stick_slip()),
    ],
    ids=[
        "motion", "motion without speed", "rests", "rests without speed", "late speed", "speed with a wrong zero",
        "speed that fades away at a stop",
        "lost samples", "coarse encoder", "no motion", "gaps", "stick-slip",
    ],
)  # fmt: skip
def test_a_joint_that_rests_has_no_stuck_sensor(made):
    assert stuck_positions([made], FACTS) == []


def test_what_a_speed_does_while_the_position_stands_still_is_no_filter():
    start_s, fades_s = 4.0, 0.5
    after_s = np.maximum(TIME_S - start_s, 0.0)
    speed = np.exp(-after_s / fades_s)
    moved = np.minimum(TIME_S, start_s) + fades_s * (1.0 - speed)
    (told,) = stuck_positions([recording(held(moved, start_s, TIME_S[-1]), speed)], FACTS)
    assert "the sensor is stuck" in told


def test_a_speed_that_differs_from_the_position_by_something_else_is_behind_no_filter():
    drive, nothing = filtered(SPEED, 0.2), slice(0, 0)
    other = 0.5 * np.cos(2.0 * np.pi * 2.1 * TIME_S)
    assert _lag_s(TIME_S, SWING, drive, nothing) == pytest.approx(0.2, rel=0.1)
    assert _lag_s(TIME_S, SWING + other, drive, nothing) == 0.0
