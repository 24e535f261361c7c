"""The look-up between calibrated curves, by hand."""

import numpy as np
import pytest

from compensator.errors import CalibrationError, LookupRangeError
from compensator.motion.friction_lookup import FrictionLookup
from compensator.motion.kinetic_friction import KineticFriction
from compensator.motor.dc_motor import MotorConstants


def curve(coulomb_a):
    return KineticFriction(coulomb_a, coulomb_a, 1.0, viscous_a_s_rad=0.001)


LOOKUP = FrictionLookup.over_load({0.1: curve(0.3), 0.0: curve(0.1), 0.05: curve(0.15)})


@pytest.mark.parametrize(("load_kg", "coulomb_a"), [(0.0, 0.1), (0.025, 0.125), (0.05, 0.15), (0.09, 0.27), (0.1, 0.3)])
def test_friction_is_interpolated_between_loads(load_kg, coulomb_a):
    np.testing.assert_allclose(LOOKUP.current_a([100.0, -100.0], load_kg), [coulomb_a + 0.1, -coulomb_a - 0.1])


def test_within_the_margin_the_last_curves_are_extended():
    # 0.15 A to 0.3 A over 50 g: 3 mA per g
    assert LOOKUP.current_a(100.0, 0.11) == pytest.approx(0.33 + 0.1)
    assert LOOKUP.current_a(100.0, -0.01) == pytest.approx(0.09 + 0.1)


@pytest.mark.parametrize("load_kg", [0.12, -0.02, float("nan")])
def test_beyond_the_margin_it_is_refused(load_kg):
    with pytest.raises(
        LookupRangeError, match=r"load is .* kg; allowed is -0.01 .. 0.11 kg: calibrated are 0 .. 0.1 kg"
    ):
        LOOKUP.current_a(1.0, load_kg)


def test_extended_friction_never_drives():
    steep = FrictionLookup.over_load({0.0: curve(0.0), 0.1: curve(1.0)}, margin=0.5)
    assert steep.current_a(1.0, -0.05) == 0.0


def test_f_load_selects_too():
    lookup = FrictionLookup.over_friction({0.1: curve(0.06), 0.27: curve(0.16)})
    assert lookup.current_a(0.1, 0.185) == pytest.approx(0.11 + 1e-4)
    with pytest.raises(LookupRangeError, match=r"F_load is 0.5 A"):
        lookup.current_a(0.1, 0.5)


def test_duty_by_hand():
    # (8 ohm * (0.1 + 0.1) A + 0.05 V s/rad * 100 rad/s) / 24 V
    constants = MotorConstants(8.0, 0.05)
    assert LOOKUP.duty(100.0, 0.0, constants, 24.0) == pytest.approx((1.6 + 5.0) / 24.0)
    assert LOOKUP.duty(-100.0, 0.0, constants, 24.0) == pytest.approx(-(1.6 + 5.0) / 24.0)
    with pytest.raises(CalibrationError, match=r"supply is 0.0 V; allowed is above 0 V"):
        LOOKUP.duty(100.0, 0.0, constants, 0.0)


@pytest.mark.parametrize(
    ("curves", "margin", "message"),
    [
        ({0.0: curve(0.1)}, 0.1, "1 curves"),
        ({0.0: curve(0.1), float("nan"): curve(0.2)}, 0.1, "rising"),
        ({0.0: curve(0.1), 0.1: curve(0.2)}, -0.1, "margin of the look-up is -0.1; allowed is 0 or more"),
    ],
)
def test_impossible_lookups_are_refused(curves, margin, message):
    with pytest.raises(CalibrationError, match=message):
        FrictionLookup.over_load(curves, margin)
