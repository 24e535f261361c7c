"""Channels that cannot be what their names say, and those that say nothing of each other."""

import warnings

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.channel_checks import check_channels
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording

COUNT_RAD = 2.0 * np.pi / 65536.0
TIME_S = np.arange(0.0, 10.0, 1.0 / 500.0)


def check(position: np.ndarray, target: np.ndarray) -> None:
    channels = {"time_s": TIME_S, "position_rad": position, "target_rad": target, "torque_n_m": np.cos(TIME_S)}
    made = Recording("hold", "hold", {}, channels)
    check_channels([made], choose_effort([made], Facts()), Facts())


@pytest.mark.parametrize("held", [0.1, 0.4, 1.1, 2.3])
def test_a_joint_that_holds_still_tells_no_sign(held):
    constant = np.full(len(TIME_S), np.round(held / COUNT_RAD) * COUNT_RAD)
    for target in (np.full(len(TIME_S), held), np.full(len(TIME_S), -held), 0.1 * np.sin(TIME_S)):
        check(constant, target)


def test_a_sign_that_differs_is_still_seen():
    with pytest.raises(UnusableDataError, match="opposite signs"):
        check(0.1 * np.sin(TIME_S), -0.1 * np.sin(TIME_S))


def speeds(of) -> None:
    """Check a joint that swings at 0.3 Hz beside a speed that is made of its own."""
    rad_s = np.cos(0.6 * np.pi * TIME_S) * 0.6 * np.pi
    channels = {"time_s": TIME_S, "position_rad": np.sin(0.6 * np.pi * TIME_S), "torque_n_m": np.cos(TIME_S)}
    made = Recording("swing", "swing", {}, channels | {"velocity_rad_s": of(rad_s)})
    check_channels([made], choose_effort([made], Facts()), Facts())


@pytest.mark.parametrize("factor", [0.5, 1.6, 2.0, -2.0])
def test_a_speed_that_is_a_multiple_of_the_position_s_own_rate_is_refused(factor):
    words = (
        rf"position_rad and velocity_rad_s differ by a factor of {1.0 / factor:.3g}, allowed is 0.667 .. 1.5; give .*"
    )
    with pytest.raises(
        UnusableDataError, match=rf"recording 'swing': {words}\(scale = {1.0 / factor:.3g} for velocity"
    ):
        speeds(lambda v: factor * v)


@pytest.mark.parametrize(
    "of",
    [
        lambda v: np.roll(v, 100),  # 0.2 s late
        lambda v: lfilter([0.01], [1.0, -0.99], v),  # a time constant of 0.2 s
        lambda v: np.trunc(v),  # in steps of 1 rad/s
        lambda v: np.clip(v, -1.7, 1.7),
        lambda v: np.where(np.abs(v) < 0.5, 0.0, v),
        lambda v: 1.1 * v,
    ],
)
def test_a_speed_as_drives_tell_it_is_taken(of):
    speeds(of)


def test_a_position_without_a_value_is_no_matter_of_scales():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(np.full(len(TIME_S), np.nan), np.sin(TIME_S))
