"""What a gear adds to the current of a load, and its inverse."""

import pytest

from compensator.errors import ModelParameterError
from compensator.motion.gear_loss import GearLoss

LOSS = GearLoss(driving=0.25, back_driving=0.2, carried_a=0.003)


@pytest.mark.parametrize("load_a", [-0.4, -0.05, 0.05, 0.4])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_there_and_back(load_a, direction):
    carried_a = LOSS.motor_current_a(load_a, direction)
    assert LOSS.load_current_a(carried_a, direction) == pytest.approx(load_a, rel=1e-12)


def test_driving_takes_more_than_the_load_and_holding_back_less():
    assert LOSS.motor_current_a(0.4, 1.0) == pytest.approx(0.5)
    assert LOSS.motor_current_a(0.4, -1.0) == pytest.approx(0.8 * 0.4 + 0.003)
    assert LOSS.motor_current_a(-0.4, 1.0) == pytest.approx(-0.8 * 0.4 - 0.003)


def test_without_loss_it_is_eq_5():
    assert GearLoss().load_current_a(0.3, -1.0) == 0.3
    assert GearLoss().motor_current_a(0.3, 1.0) == 0.3


def test_what_the_friction_behind_the_teeth_explains_is_no_load():
    assert LOSS.load_current_a(0.002, -1.0) == 0.0


@pytest.mark.parametrize("wrong", [{"driving": -0.1}, {"back_driving": 1.0}, {"carried_a": float("nan")}])
def test_impossible_losses_are_refused(wrong):
    with pytest.raises(ModelParameterError, match=next(iter(wrong))):
        GearLoss(**wrong)
