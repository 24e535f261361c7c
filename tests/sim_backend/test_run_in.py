from math import exp

import pytest

from sim_backend.mechanisms.motor.motor import OPEN
from tests.sim_backend.plants import RATIO, RESISTANCE, SUPPLY, K, duty_for_torque, plant, run

COULOMB = 5e-3
NEW = {"fraction": 0.6, "distance_rad": 200.0}


def test_friction_falls_with_the_way_turned_and_not_with_time() -> None:
    worn = plant(friction={"coulomb_n_m": COULOMB, "static_n_m": COULOMB}, run_in=NEW)
    worn.advance(OPEN, 0.0, 50_000)
    for _ in range(4):
        way = float(worn._state["travelled_rad"][0])
        limit = duty_for_torque(RATIO * COULOMB * (1.0 + 0.6 * exp(-way / 200.0)))
        before = worn.truth().rotor_rad
        run(worn, limit * 0.999, 0.1)
        assert worn.truth().rotor_rad == pytest.approx(before, abs=1e-6)
        run(worn, limit * 1.001, 0.1)
        assert worn.truth().rotor_rad > before + 1e-5
        run(worn, 0.5, 0.5)
        worn.advance(OPEN, 0.0, 30_000)
        assert worn.truth().rotor_rad_s == 0.0


def test_way_is_counted_at_the_motor_in_both_directions() -> None:
    turned = plant(friction={"viscous_n_m_s_rad": 1e-4}, run_in=NEW)
    for duty in (0.5, -0.5, 0.5):
        run(turned, duty, 2.0)
    speed = K * 0.5 * SUPPLY / RESISTANCE / (1e-4 + K**2 / RESISTANCE)
    assert turned._state["travelled_rad"][0] == pytest.approx(speed * 6.0, rel=0.05)
    assert turned.truth().rotor_rad * RATIO == pytest.approx(speed * 2.0, rel=0.1)
