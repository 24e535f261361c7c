"""Eqs (1), (2), against hand-worked numbers."""

import math

import numpy as np
import pytest

from compensator.errors import ModelParameterError
from compensator.motion.kinetic_friction import KineticFriction

CURVE = KineticFriction(coulomb_a=0.2, static_a=0.3, stribeck_speed_rad_s=2.0, shape=2.0, viscous_a_s_rad=0.01)


def test_eq_2_by_hand():
    # at v = vs the Stribeck share is (0.3 - 0.2) / e, viscous 0.01 * 2
    assert CURVE.sliding_a(2.0) == pytest.approx(0.2 + 0.1 / math.e + 0.02)
    assert CURVE.sliding_a(20.0) == pytest.approx(0.2 + 0.2)


def test_eq_2_is_odd_in_speed():
    speeds = np.array([-5.0, -0.1, 0.1, 5.0])
    np.testing.assert_allclose(CURVE.sliding_a(speeds), -CURVE.sliding_a(-speeds))


@pytest.mark.parametrize(
    "wrong",
    [
        {"coulomb_a": -0.1, "static_a": 0.3, "stribeck_speed_rad_s": 1.0},
        {"coulomb_a": 0.4, "static_a": 0.3, "stribeck_speed_rad_s": 1.0},
        {"coulomb_a": 0.2, "static_a": 0.3, "stribeck_speed_rad_s": 0.0},
        {"coulomb_a": 0.2, "static_a": 0.3, "stribeck_speed_rad_s": 1.0, "shape": 0.0},
        {"coulomb_a": 0.2, "static_a": math.inf, "stribeck_speed_rad_s": 1.0},
    ],
)
def test_impossible_curves_are_refused(wrong):
    with pytest.raises(ModelParameterError):
        KineticFriction(**wrong)
