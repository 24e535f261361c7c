from math import asin, exp, pi, sqrt, tan
from typing import Any

import pytest

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from tests.sim_backend.plants import ARM, duty_for_torque, plant, run

STIFFNESS = 1000.0
WALL = {"wall": {"present": True, "angle_rad": 0.5, "stiffness_n_m_rad": STIFFNESS}}
STOPS = {"end_stops": {"present": True, "lower_rad": -0.4, "upper_rad": 0.6, "stiffness_n_m_rad": STIFFNESS}}


@pytest.mark.parametrize(
    ("tables", "sign", "angle"),
    [
        (WALL, 1.0, 0.5),
        ({"wall": WALL["wall"] | {"angle_rad": -0.5}}, -1.0, -0.5),
        (STOPS, 1.0, 0.6),
        (STOPS, -1.0, -0.4),
    ],
)
def test_obstacle_meets_the_torque_that_leans_on_it(tables: dict[str, Any], sign: float, angle: float) -> None:
    torque = 0.3
    leaning = plant(friction={"viscous_n_m_s_rad": 1e-3}, **tables)
    run(leaning, sign * duty_for_torque(torque), 3.0)
    truth = leaning.truth()
    assert truth.leant_n_m == pytest.approx(-sign * torque, rel=1e-9)
    assert truth.arm_rad == pytest.approx(angle + sign * torque / STIFFNESS, rel=1e-9)
    run(leaning, -sign * duty_for_torque(torque), 0.1)
    assert leaning.truth().leant_n_m == 0.0
    assert sign * leaning.truth().arm_rad < sign * angle


def test_wall_in_one_way_leaves_the_other_free() -> None:
    turning = plant(friction={"viscous_n_m_s_rad": 1e-3}, **WALL)
    run(turning, -0.1, 3.0)
    assert turning.truth().arm_rad < -5.0
    assert turning.truth().leant_n_m == 0.0


@pytest.mark.parametrize("damping", [0.0, 0.5, 2.0])
@pytest.mark.parametrize(("tables", "sign"), [(WALL, 1.0), (STOPS, -1.0)])
def test_impact_turns_momentum_round_and_rebounds_as_theory_says(
    tables: dict[str, dict[str, Any]], sign: float, damping: float
) -> None:
    """The arm alone, inside a wide free play, against the obstacle."""
    step_s = 2e-6
    damped = {name: table | {"damping_n_m_s_rad": damping} for name, table in tables.items()}
    hit = plant(step_s=step_s, gear={"backlash_rad": 6.0}, **damped)
    hit.place(0.0, 0.0, arm_rad_s=sign * 5.0)
    impulse = 0.0
    for _ in range(round(0.14 / step_s)):
        hit.advance(OPEN, 0.0, 1)
        push = hit.truth().leant_n_m
        assert push * sign <= 0.0
        impulse += step_s * push
    after = hit.truth().arm_rad_s
    assert impulse == pytest.approx(ARM * (after - sign * 5.0), rel=1e-9)
    # spring and damper that cannot pull: the arm leaves when the force is zero, not when the spring is slack
    alpha = asin(damping / (2.0 * sqrt(STIFFNESS * ARM)))
    assert -sign * after == pytest.approx(5.0 * exp(-tan(alpha) * (pi - 2.0 * alpha)), rel=2e-3)


@pytest.mark.parametrize("stiffness", [1e3, 1e5, 3.9e5])
@pytest.mark.parametrize("damping", [0.0, 2.0])
@pytest.mark.parametrize("start_rad", [0.0, 1.1e-4, 2.9e-4])
def test_impact_makes_no_energy_however_stiff_the_wall_and_wherever_in_the_step_it_is_met(
    stiffness: float, damping: float, start_rad: float
) -> None:
    """Up to a step times frequency of 1. What Newton's method leaves over is 1e-9 of a step's way."""
    wall = WALL["wall"] | {"stiffness_n_m_rad": stiffness, "damping_n_m_s_rad": damping}
    hit = plant(gear={"backlash_rad": 6.0}, wall=wall)
    hit.place(0.0, start_rad, arm_rad_s=5.0)
    began = hit.energy().stored_j
    hit.advance(OPEN, 0.0, 2000)
    energy = hit.energy()
    assert hit.truth().arm_rad_s < 0.0
    assert energy.stored_j + energy.lost_j == pytest.approx(began, rel=1e-7)
    assert energy.stored_j <= began * (1.0 + 1e-9)


def test_wall_and_end_stop_behind_it_are_met_one_after_the_other() -> None:
    stop = {"end_stops": {"present": True, "upper_rad": 0.5003, "stiffness_n_m_rad": 2e5, "damping_n_m_s_rad": 0.0}}
    hit = plant(gear={"backlash_rad": 6.0}, **WALL, **stop)
    hit.place(0.0, 0.0, arm_rad_s=5.0)
    began = hit.energy().stored_j
    hit.advance(OPEN, 0.0, 2000)
    assert hit.truth().arm_rad_s < 0.0
    assert hit.energy().stored_j + hit.energy().lost_j == pytest.approx(began, rel=1e-7)


def test_shaft_in_series_with_the_teeth_twists_and_swings_as_one_spring() -> None:
    tables: dict[str, Any] = {
        "gear": {"stiffness_n_m_rad": 1000.0, "damping_n_m_s_rad": 0.0},
        "shaft": {"compliance_rad_n_m": 4e-3},
    }
    held = plant(arm_friction={"coulomb_n_m": 1.0, "static_n_m": 1.0}, friction={"viscous_n_m_s_rad": 1e-3}, **tables)
    run(held, duty_for_torque(0.2), 5.0)
    assert held.truth().rotor_rad == pytest.approx(0.2 * (1e-3 + 4e-3), rel=1e-9)
    swinging = plant(**tables)
    swinging.place(1e-3, 0.0)
    energies = [swinging.energy().stored_j]
    assert energies[0] == pytest.approx(0.5 * 200.0 * 1e-6, rel=1e-12)
    swinging.advance(VOLTAGE, 0.0, 0)
    reduced = 1.0 / (1.0 / (10.0**2 * 2e-5) + 1.0 / ARM)
    period_s = 2.0 * pi * sqrt(reduced / 200.0)
    swinging.advance(OPEN, 0.0, round(50.0 * period_s / 1e-4))
    truth = swinging.truth()
    # fifty periods on it is back; the midpoint rule loses (w h)^2 / 12 of a period in each
    lag = 2.0 * pi * 50.0 * (2.0 * pi / period_s * 1e-4) ** 2 / 12.0
    off = 2.0 * pi * (round(50.0 * period_s / 1e-4) * 1e-4 / period_s - 50.0)
    assert truth.rotor_rad - truth.arm_rad == pytest.approx(1e-3 * (1.0 - 0.5 * (off - lag) ** 2), rel=1e-3)
