"""Section 3.1 of the paper, against hand-worked numbers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compensator.errors import ModelParameterError
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants

MOTOR = MotorConstants(resistance_ohm=4.0, back_emf_v_s_rad=0.05)


def test_eq_3_by_hand():
    # (24 V * 0.5 - 0.05 V s/rad * 100 rad/s) / 4 ohm = (12 - 5) / 4
    assert motor.current_a(MOTOR, 0.5, 100.0, 24.0) == pytest.approx(1.75)


def test_eq_3_is_the_ohmic_current_at_standstill():
    assert motor.current_a(MOTOR, -0.25, 0.0, 24.0) == pytest.approx(-1.5)


def test_duty_of_friction_holds_the_back_emf():
    assert motor.friction_duty(MOTOR, 0.3, 100.0, 24.0) == pytest.approx((4 * 0.3 + 0.05 * 100) / 24)


def test_arrays_go_through():
    currents = motor.current_a(MOTOR, np.array([0.5, 0.0]), np.array([100.0, 0.0]), 24.0)
    np.testing.assert_allclose(currents, [1.75, 0.0])


values = st.floats(-1.0, 1.0)
speeds = st.floats(-300.0, 300.0)
motors = st.builds(MotorConstants, st.floats(0.1, 50.0), st.floats(0.0, 1.0))
supplies = st.floats(5.0, 60.0)


@given(motors, values, speeds, supplies)
def test_the_inverse_relation_returns_the_current(constants, current, speed, supply):
    duty = motor.duty(constants, current, speed, supply)
    assert motor.current_a(constants, duty, speed, supply) == pytest.approx(current, abs=1e-7)


@pytest.mark.parametrize(("resistance", "back_emf"), [(0.0, 0.1), (-1.0, 0.1), (1.0, -0.1), (float("nan"), 0.1)])
def test_impossible_motors_are_refused(resistance, back_emf):
    with pytest.raises(ModelParameterError, match="allowed"):
        MotorConstants(resistance, back_emf)
