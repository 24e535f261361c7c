from math import isnan, nan, pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.canopen.cia301.period import cycle_s
from drivers.canopen.cia402.profiles import CIA402, EPOS4
from drivers.canopen.cia402.scale import DriveScale
from drivers.canopen.cia402.units import (
    VELOCITY_CODES,
    VELOCITY_UNITS,
    interpolation_periods,
    velocity_unit_name,
    velocity_unit_rad_s,
)
from drivers.joint import JointScale

SCALE = DriveScale(JointScale(4096, 20.0), 2.0, pi / 30)
REVERSED = DriveScale(JointScale(4096, 20.0, motor_sign=-1, encoder_sign=-1), 2.0, pi / 30)


@pytest.mark.parametrize(
    ("code", "rad_s"),
    [
        (0x00B44700, 2 * pi / 60),  # EPOS4: rpm
        (0xFFB44700, 2 * pi / 600),  # Synapticon: 0.1 rpm
        (0xFDB44700, 2 * pi / 60000),
        (0x00B50300, 2 * pi / 4096),
        (0x00100300, 1.0),
        (0x00410300, pi / 180),
        (0x00010300, None),  # metres per second
        (0x00B40000, None),
    ],
)
def test_velocity_units(code, rad_s):
    assert velocity_unit_rad_s(code, 4096) == (None if rad_s is None else pytest.approx(rad_s))


def test_every_name_of_a_unit_has_a_code_and_back():
    for name in VELOCITY_UNITS:
        assert velocity_unit_name(VELOCITY_CODES[name]) == name
        assert velocity_unit_rad_s(VELOCITY_CODES[name], 4096) is not None


@pytest.mark.parametrize(
    ("period_s", "coded"),
    [(0.001, (1, -3)), (0.005, (5, -3)), (0.0005, (5, -4)), (0.002, (2, -3)), (0.00125, (125, -5)), (0.00012345, None)],
)
def test_interpolation_periods(period_s, coded):
    assert next(iter(interpolation_periods(period_s, None)), None) == coded


def test_the_form_of_a_period_that_keeps_the_drives_exponent_comes_first():
    assert interpolation_periods(0.005, -4)[0] == (50, -4)
    assert interpolation_periods(0.005, -6)[0] == (5, -3), "5000 does not fit one byte"


def test_one_turn_per_minute_of_the_motor_seen_at_the_joint():
    assert SCALE.velocity_rad_s == pytest.approx(pi / 30 / 20)
    assert REVERSED.velocity_rad_s == pytest.approx(-pi / 30 / 20)


def test_currents_may_be_told_in_permille_or_in_milliamperes():
    assert SCALE.current_a(CIA402.current) == pytest.approx(2e-3)
    assert SCALE.current_a(EPOS4.current) == pytest.approx(1e-3)


def test_one_ampere_of_two_is_500_permille():
    assert SCALE.torque_permille(1.0) == 500
    assert REVERSED.torque_permille(1.0) == -500


@given(st.floats(-60.0, 60.0))
def test_current_is_rounded_to_the_nearest_permille(current_a):
    assert abs(SCALE.torque_permille(current_a) * 2e-3 - current_a) <= 1e-3 * (1 + 1e-9)


def test_the_most_that_can_be_said_fits_the_objects():
    scale = DriveScale(JointScale(4096, 20.0, zero_rad=0.3), 2.0, 1.0)
    for sign in (1, -1):
        assert abs(scale.torque_permille(sign * scale.highest_current_a)) <= 0x7FFF
        assert -0x80000000 <= scale.joint.counts(sign * scale.farthest_rad) <= 0x7FFFFFFF


def test_an_unknown_unit_stays_unknown():
    assert isnan(DriveScale(JointScale(4096, 20.0), 2.0, nan).velocity_rad_s)


def test_a_cycle_of_four_frames_takes_about_400_us_at_1_mbit_s():
    assert cycle_s((0, 6, 8, 8), 1_000_000) == pytest.approx(400e-6, rel=0.1)
    assert cycle_s((0, 6, 8, 8), 125_000) == pytest.approx(8 * cycle_s((0, 6, 8, 8), 1_000_000))
