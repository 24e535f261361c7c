"""The motor's constants at another temperature."""

import pytest

from compensator.errors import ModelParameterError
from compensator.motor.dc_motor import MotorConstants, at_temperature

COLD = MotorConstants(resistance_ohm=8.0, back_emf_v_s_rad=0.05)


def test_copper_resists_more_and_magnets_pull_less():
    warm = at_temperature(COLD, 75.0, 25.0, 0.00393, 0.002)
    assert warm.resistance_ohm == pytest.approx(8.0 * 1.1965)
    assert warm.back_emf_v_s_rad == pytest.approx(0.05 * 0.9)


def test_at_the_reference_nothing_changes():
    assert at_temperature(COLD, 25.0, 25.0, 0.00393, 0.002) == COLD


def test_where_the_law_ends_there_is_no_number():
    with pytest.raises(ModelParameterError, match="resistance"):
        at_temperature(COLD, -300.0, 25.0, 0.00393)
