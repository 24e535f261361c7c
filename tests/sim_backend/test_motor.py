from math import exp, sin

import pytest

from sim_backend.mechanisms.motor.motor import BRAKE, CURRENT, OPEN, VOLTAGE
from tests.sim_backend.plants import ARM, RATIO, RESISTANCE, ROTOR, SUPPLY, K, plant, run, settled_speed

INERTIA = RATIO**2 * ROTOR + ARM


def test_stalled_motor_draws_voltage_over_resistance() -> None:
    held = plant(friction={"coulomb_n_m": 9.0, "static_n_m": 9.0})
    run(held, 0.5, 0.1)
    assert held.truth().current_a == pytest.approx(0.5 * SUPPLY / RESISTANCE, rel=1e-12)
    assert held.truth().rotor_rad == 0.0


def test_stall_torque_holds_the_load_where_gravity_equals_it() -> None:
    hanging = plant(load={"mass_kg": 0.2}, friction={"viscous_n_m_s_rad": 1e-3})
    run(hanging, 0.05, 5.0)
    moment = 0.2 * 9.80665 * 0.3
    wanted = RATIO * K * 0.05 * SUPPLY / RESISTANCE / moment
    truth = hanging.truth()
    assert truth.contact_n_m == pytest.approx(wanted * moment, rel=1e-6)
    assert sin(truth.arm_rad) == pytest.approx(wanted, rel=1e-6)


def test_terminal_speed_is_where_back_emf_and_friction_meet_the_supply() -> None:
    viscous, coulomb = 1e-4, 5e-3
    spinning = plant(friction={"viscous_n_m_s_rad": viscous, "coulomb_n_m": coulomb, "static_n_m": coulomb})
    motor_rad_s = (K * 0.6 * SUPPLY / RESISTANCE - coulomb) / (viscous + K**2 / RESISTANCE)
    assert settled_speed(spinning, 0.6) * RATIO == pytest.approx(motor_rad_s, rel=1e-9)


def test_speed_rises_with_the_mechanical_time_constant() -> None:
    spinning = plant()
    time_constant_s = INERTIA * RESISTANCE / (RATIO * K) ** 2
    run(spinning, 0.5, round(time_constant_s, 4))
    wanted = 0.5 * SUPPLY / K / RATIO * (1.0 - exp(-round(time_constant_s, 4) / time_constant_s))
    # the teeth take a little of the start: their period over the time constant, squared
    assert spinning.truth().rotor_rad_s == pytest.approx(wanted, rel=2e-3)


def test_current_rises_with_the_electrical_time_constant() -> None:
    held = plant(motor={"inductance_h": 0.02}, friction={"coulomb_n_m": 9.0, "static_n_m": 9.0})
    run(held, 0.5, 0.01)  # L / R
    # backward Euler: first order, half a step over the time constant
    assert held.truth().current_a == pytest.approx(5.0 * (1.0 - exp(-1.0)), rel=0.5 * 1e-4 / 0.01)


def test_open_terminals_carry_no_current_however_fast_the_motor_turns() -> None:
    coasting = plant()
    settled_speed(coasting, 0.5)
    coasting.advance(OPEN, 0.7, 100)
    assert coasting.truth().current_a == 0.0
    assert coasting.truth().rotor_rad_s == pytest.approx(25.0, rel=1e-6)


def test_shorted_terminals_brake_with_the_mechanical_time_constant() -> None:
    braked = plant()
    before = settled_speed(braked, 0.5)
    braked.advance(BRAKE, 0.0, 500)
    decay = exp(-0.05 * (RATIO * K) ** 2 / RESISTANCE / INERTIA)
    assert braked.truth().rotor_rad_s == pytest.approx(before * decay, rel=2e-3)


def test_current_loop_sets_the_current_until_the_supply_is_used_up() -> None:
    driven = plant(current_sensor={"present": True}, current_loop={"present": True, "time_constant_s": 1e-3})
    driven.advance(CURRENT, 0.4, 100)
    assert driven.truth().current_a == pytest.approx(0.4, rel=1e-4)
    driven.advance(CURRENT, 0.4, 100_000)
    # without friction it runs away until the back-EMF leaves no voltage
    assert driven.truth().rotor_rad_s * RATIO * K <= SUPPLY * (1.0 + 1e-9)
    assert driven.truth().rotor_rad_s * RATIO * K == pytest.approx(SUPPLY, rel=1e-3)


def test_positive_duty_turns_the_joint_positive() -> None:
    driven = plant()
    driven.advance(VOLTAGE, 0.1, 100)
    assert driven.truth().arm_rad > 0.0
