from math import exp, sin

import pytest

from sim_backend.mechanisms.friction.friction import Friction, dry_friction
from sim_backend.mechanisms.motor.motor import OPEN
from sim_backend.plant.jit import pack
from tests.sim_backend.compiled import callable_from_python
from tests.sim_backend.plants import RATIO, RESISTANCE, SUPPLY, G, K, duty_for_torque, plant, run, settled_speed

STATIC, COULOMB = 8e-3, 5e-3
DRY = {"static_n_m": STATIC, "coulomb_n_m": COULOMB, "stribeck_rad_s": 5.0}
HOLDS = duty_for_torque(RATIO * STATIC)  # the duty at which the motor's torque is just static friction


def _terminal_rad_s(duty: float, dry_n_m: float, viscous: float = 0.0) -> float:
    """Motor speed at which torque and friction meet."""
    return (K * duty * SUPPLY / RESISTANCE - dry_n_m) / (viscous + K**2 / RESISTANCE)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_stick_holds_exactly_below_the_limit_and_lets_go_above(sign: float) -> None:
    stuck = plant(friction=DRY)
    run(stuck, sign * HOLDS * (1.0 - 1e-9), 1.0)
    assert stuck.truth().rotor_rad == 0.0
    assert stuck.truth().rotor_rad_s == 0.0
    run(stuck, sign * HOLDS * (1.0 + 1e-6), 1.0)
    assert sign * stuck.truth().rotor_rad > 0.0


def test_moving_joint_stops_exactly_and_stays() -> None:
    stopping = plant(friction=DRY, load={"mass_kg": 0.2, "balanced": True})
    settled_speed(stopping, 0.3)
    stopping.advance(OPEN, 0.0, 100_000)
    first = stopping.truth()
    stopping.advance(OPEN, 0.0, 10_000)
    assert first.rotor_rad_s == 0.0
    assert stopping.truth().rotor_rad == first.rotor_rad


def test_friction_law_is_the_general_kinetic_one() -> None:
    law = Friction(coulomb_n_m=2.0, static_n_m=3.0, stribeck_rad_s=0.5, stribeck_exponent=1.3, growth_per_n=0.4)
    torque = callable_from_python(dry_friction)
    wanted = (2.0 + exp(-((0.7 / 0.5) ** 1.3))) * (1.0 + 0.4 * 5.0)
    assert torque(pack(law)[0], -0.7, 5.0, 1.0, 1.0) == pytest.approx(wanted, rel=1e-12)
    assert torque(pack(law)[0], 0.0, 0.0, 1.0, 1.0) == 3.0
    assert torque(pack(law)[0], 1e3, 0.0, 1.0, 1.0) == 2.0


def test_friction_grows_with_the_weight_on_the_axis() -> None:
    friction = DRY | {"growth_per_n": 0.5}
    duty = 0.3
    for load_kg in (0.0, 0.1, 0.4):
        loaded = plant(friction=friction, load={"mass_kg": load_kg, "balanced": True})
        wanted = _terminal_rad_s(duty, COULOMB * (1.0 + 0.5 * load_kg * G))
        assert settled_speed(loaded, duty, 10.0) * RATIO == pytest.approx(wanted, rel=1e-8)


def test_arm_side_friction_is_carried_by_the_teeth() -> None:
    dragged = plant(arm_friction={"coulomb_n_m": 0.03, "static_n_m": 0.03, "viscous_n_m_s_rad": 0.01})
    speed = settled_speed(dragged, 0.3)
    assert dragged.truth().contact_n_m == pytest.approx(0.03 + 0.01 * speed, rel=1e-9)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_viscous_asymmetry_changes_the_terminal_speed_by_direction(direction: float) -> None:
    skewed = plant(friction={"viscous_n_m_s_rad": 1e-3}, viscous_asymmetry={"fraction": 0.3})
    wanted = _terminal_rad_s(0.5, 0.0, 1e-3 * (1.0 + 0.3 * direction))
    assert direction * settled_speed(skewed, 0.5 * direction) * RATIO == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_coulomb_asymmetry_changes_terminal_speed_and_stick_limit_by_direction(direction: float) -> None:
    scale = 1.0 - 0.2 * direction
    skewed = plant(friction=DRY, coulomb_asymmetry={"fraction": -0.2})
    run(skewed, direction * HOLDS * scale * (1.0 - 1e-9), 0.5)
    assert skewed.truth().rotor_rad == 0.0
    wanted = _terminal_rad_s(0.5, COULOMB * scale)
    assert direction * settled_speed(skewed, 0.5 * direction) * RATIO == pytest.approx(wanted, rel=1e-9)


def test_drag_grows_with_the_square_of_the_speed() -> None:
    coefficient = 2e-6
    fanned = plant(drag={"coefficient_n_m_s2_rad2": coefficient})
    motor_rad_s = settled_speed(fanned, 0.8) * RATIO
    left = K * (0.8 * SUPPLY - K * motor_rad_s) / RESISTANCE
    assert coefficient * motor_rad_s**2 == pytest.approx(left, rel=1e-8)


def test_periodic_friction_is_strongest_at_its_phase() -> None:
    bent = plant(friction=DRY, periodic_friction={"fraction": 0.4, "cycles_per_turn": 1.0, "phase_rad": 1.0})
    for angle, scale in ((1.0, 1.4), (1.0 + 3.141592653589793, 0.6)):
        for over, moves in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
            bent.place(angle, angle)
            run(bent, HOLDS * scale * over, 0.2)
            assert (bent.truth().rotor_rad != angle) is moves


@pytest.mark.parametrize(("factor", "moves"), [(1.3 * 0.99, False), (1.3 * 1.01, True)])
def test_mesh_loss_is_paid_by_the_motor_when_it_lifts(factor: float, moves: bool) -> None:
    lifted = _on_the_load_friction(factor)
    assert (lifted.truth().rotor_rad > 1.5 + 1e-3) is moves


@pytest.mark.parametrize(("factor", "falls"), [(0.8 * 1.01, False), (0.8 * 0.99, True)])
def test_mesh_loss_helps_the_motor_when_the_load_drives(factor: float, falls: bool) -> None:
    lowered = _on_the_load_friction(factor)
    assert (lowered.truth().rotor_rad < 1.5 - 1e-3) is falls


def _on_the_load_friction(factor: float) -> object:
    """A load at 1.5 rad, friction by mesh loss alone, motor torque as a factor of gravity's."""

    gravity = 0.2 * G * 0.3 * sin(1.5)
    held = plant(load={"mass_kg": 0.2}, load_friction={"driving": 0.3, "back_driving": 0.2})
    # the teeth start loaded by what gravity needs
    held.place(1.5, 1.5 - gravity / 1000.0)
    run(held, duty_for_torque(gravity * factor), 1.0)
    return held
