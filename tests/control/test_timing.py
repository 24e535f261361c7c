"""A drive that is too slow, or whose watchdog does not fit, is refused before motion, with the numbers."""

from dataclasses import replace
from math import inf, nan

import pytest

from bench.config.sections import ServoSettings
from bench.control.servo import check_modes
from bench.control.timing import check_timing
from bench.errors import ConfigurationError
from drivers.contract import Mode
from tests.control.fake_drive import FakeDrive

DRIVE = replace(FakeDrive().describe(), max_rate_hz=200.0, watchdog_s=0.1)


@pytest.mark.parametrize("period_s", [0.005, 0.05])
def test_a_period_that_fits(period_s):
    check_timing(DRIVE, period_s)


def test_too_fast_for_the_drive():
    with pytest.raises(
        ConfigurationError, match=r"control.period_s is 0.002 s; drive 'fake' sustains 200 cycles .* 0.005 s"
    ):
        check_timing(DRIVE, 0.002)


def test_what_was_noticed_of_line_and_host_stands_in_place_of_general_advice():
    with pytest.raises(ConfigurationError, match=r"is wanted\. Choose a longer period or a faster line"):
        check_timing(DRIVE, 0.002)
    noted = replace(DRIVE, notes=("the USB adapter holds each answer back. Set it to 1 ms",))
    with pytest.raises(ConfigurationError, match=r"is wanted\. the USB adapter holds .* back\. Set it to 1 ms"):
        check_timing(noted, 0.002)


@pytest.mark.parametrize("watchdog_s", [0.015, 10.0, inf, nan])
def test_a_watchdog_that_does_not_fit(watchdog_s):
    with pytest.raises(ConfigurationError, match=rf"after {watchdog_s:g} s; 0.02 s .* 2 s is wanted"):
        check_timing(replace(DRIVE, watchdog_s=watchdog_s), 0.01)


def test_a_position_loop_that_the_drive_does_not_close():
    settings = ServoSettings(closed_by="drive")
    check_modes(settings, replace(DRIVE, modes=frozenset({Mode.POSITION})))
    with pytest.raises(ConfigurationError, match=r"drive 'fake' has no position mode \(it has duty\)"):
        check_modes(settings, DRIVE)
