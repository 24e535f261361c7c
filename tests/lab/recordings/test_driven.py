"""A joint that something else turns, and one that coasts: only the first is left out."""

import numpy as np

from compensator.lab.recordings.driven import driven_from_outside

TIME_S = np.arange(0.0, 40.0, 0.01)
OFF = (TIME_S > 10.0) & (TIME_S < 30.0)


def effort() -> np.ndarray:
    return np.where(OFF, 0.0, 0.3 + 0.01 * np.sin(TIME_S))


def test_turned_at_constant_speed_without_effort() -> None:
    found = driven_from_outside(TIME_S, 3.0 * TIME_S, effort())
    assert found[OFF].all()
    assert not found[~OFF].any()


def test_a_hand_that_moves_it_to_and_fro() -> None:
    assert driven_from_outside(TIME_S, np.sin(2.0 * TIME_S), effort())[OFF].all()


def test_a_joint_that_coasts_is_kept() -> None:
    speed = 3.0 * np.exp(-np.maximum(TIME_S - 10.0, 0.0) / 60.0)
    assert not driven_from_outside(TIME_S, np.cumsum(speed) * 0.01, effort()).any()


def test_a_pendulum_that_swings_out_is_kept() -> None:
    swing = np.exp(-0.02 * TIME_S) * np.cos(3.0 * TIME_S)
    assert not driven_from_outside(TIME_S, swing, effort()).any()


def test_a_joint_that_stands_is_kept() -> None:
    position = np.where(TIME_S < 10.0, 3.0 * TIME_S, 30.0)
    assert not driven_from_outside(TIME_S, position, effort()).any()


def test_a_measured_effort_is_never_exactly_nothing() -> None:
    noisy = effort() + 1e-6 * np.random.default_rng(0).standard_normal(len(TIME_S))
    assert not driven_from_outside(TIME_S, 3.0 * TIME_S, noisy).any()
