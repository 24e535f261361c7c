"""Channels that cannot be what their names say, and those that say nothing of each other."""

import warnings

import numpy as np
import pytest

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


def test_a_position_without_a_value_is_no_matter_of_scales():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(np.full(len(TIME_S), np.nan), np.sin(TIME_S))
