"""Eqs (9), (10)."""

import pytest

from compensator.errors import ModelParameterError
from compensator.rest.breakaway_fit import estimate


def test_by_hand():
    found = estimate(min_current_a=0.1, max_current_a=0.85)
    assert found.load_current_a == pytest.approx(0.475)
    assert found.friction_current_a == pytest.approx(0.375)


def test_the_band_may_lie_on_both_sides_of_zero():
    assert estimate(-0.3, 0.2).load_current_a == pytest.approx(-0.05)


@pytest.mark.parametrize(("low", "high"), [(0.2, 0.2), (0.3, 0.2), (float("nan"), 0.2)])
def test_no_band_no_estimate(low, high):
    with pytest.raises(ModelParameterError, match="I_max"):
        estimate(low, high)
