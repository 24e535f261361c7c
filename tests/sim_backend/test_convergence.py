from math import log2
from typing import Any

import pytest

from tests.sim_backend.plants import plant, run


@pytest.mark.parametrize(
    ("tables", "order"),
    [
        ({"friction": {"viscous_n_m_s_rad": 1e-4}, "spring": {"stiffness_n_m_rad": 0.3}}, 1.9),
        # where motion reverses through stick, the instant of it is known to a step
        ({"friction": {"coulomb_n_m": 5e-3, "static_n_m": 7e-3, "stribeck_rad_s": 5.0}}, 0.9),
    ],
)
def test_halving_the_step_divides_the_error_as_the_scheme_promises(tables: dict[str, Any], order: float) -> None:
    gear = {"gear": {"damping_n_m_s_rad": 2.0} | tables.get("gear", {})}
    errors = []
    exact = _swing(1e-6, tables | gear)
    for step_s in (1e-4, 2.5e-5):
        errors.append(abs(_swing(step_s, tables | gear) - exact))
    assert log2(errors[0] / errors[1]) / 2.0 > order
    assert errors[0] < 1e-3


def test_moment_at_which_teeth_close_within_a_step_hardly_matters() -> None:
    """Had each closing to wait for the next step, the arm would be late by that step's way."""
    tables = {
        "gear": {"backlash_rad": 0.01, "damping_n_m_s_rad": 2.0},
        "friction": {"coulomb_n_m": 2e-3, "static_n_m": 2e-3},
    }
    speed_rad_s = (_swing(1e-6, tables, 0.21) - _swing(1e-6, tables, 0.19)) / 0.02
    exact = _swing(1e-6, tables)
    for step_s in (1e-4, 2.5e-5):
        assert abs(_swing(step_s, tables) - exact) < 0.05 * abs(speed_rad_s) * 1e-4


def _swing(step_s: float, tables: dict[str, Any], push_s: float = 0.2) -> float:
    swung = plant(step_s=step_s, load={"mass_kg": 0.2}, **tables)
    run(swung, 0.08, push_s)
    run(swung, -0.03, 0.3)
    return swung.truth().arm_rad
