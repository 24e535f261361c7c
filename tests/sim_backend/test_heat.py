from math import exp, isnan

import pytest

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from tests.sim_backend.plants import RATIO, RESISTANCE, SUPPLY, K, plant, run, settled_speed

QUICK = {"present": True, "ambient_c": 20.0, "start_c": 20.0, "winding_j_k": 0.5, "housing_j_k": 1.0}


def test_stalled_motor_warms_to_where_loss_and_cooling_meet() -> None:
    held = plant(friction={"coulomb_n_m": 9.0, "static_n_m": 9.0}, heat=QUICK)
    run(held, 0.1, 200.0)
    power_w = (0.1 * SUPPLY) ** 2 / RESISTANCE
    truth = held.truth()
    assert truth.housing_c == pytest.approx(20.0 + 8.0 * power_w, rel=1e-6)
    assert truth.winding_c == pytest.approx(truth.housing_c + 3.0 * power_w, rel=1e-6)


def test_all_heat_is_stored_where_none_can_leave() -> None:
    tight = QUICK | {"housing_to_ambient_k_w": 1e9}
    warmed = plant(heat=tight, friction={"coulomb_n_m": 5e-3, "static_n_m": 5e-3, "viscous_n_m_s_rad": 1e-4})
    run(warmed, 0.4, 10.0)
    truth = warmed.truth()
    stored_j = 0.5 * (truth.winding_c - 20.0) + 1.0 * (truth.housing_c - 20.0)
    assert stored_j == pytest.approx(warmed.energy().lost_j - _tooth_loss(warmed), rel=1e-6)


def _tooth_loss(warmed: object) -> float:
    return float(warmed._state["contact_loss_j"][0])  # type: ignore[attr-defined]


def test_housing_cools_to_the_ambient() -> None:
    cooling = plant(heat=QUICK | {"start_c": 50.0, "winding_to_housing_k_w": 1e-2})
    cooling.advance(OPEN, 0.0, 120_000)  # one time constant: 1.5 J/K times 8 K/W
    assert cooling.truth().housing_c == pytest.approx(20.0 + 30.0 * exp(-1.0), rel=1e-3)


def test_temperature_is_reported_only_by_a_drive_that_warms() -> None:
    assert isnan(plant().advance(VOLTAGE, 0.1, 10)[3])
    assert plant(heat=QUICK).advance(VOLTAGE, 0.0, 10)[3] == 20.0


@pytest.mark.parametrize("temperature_c", [0.0, 25.0, 45.0])
def test_warm_grease_drags_less(temperature_c: float) -> None:
    greased = plant(
        friction={"viscous_n_m_s_rad": 1e-3}, heat={"start_c": temperature_c}, lubricant={"vogel_k": 1000.0}
    )
    viscous = 1e-3 * exp(1000.0 / (temperature_c + 100.0) - 1000.0 / 125.0)
    wanted = K * 0.5 * SUPPLY / RESISTANCE / (viscous + K**2 / RESISTANCE)
    assert settled_speed(greased, 0.5) * RATIO == pytest.approx(wanted, rel=1e-9)
