"""The plant against solutions by hand: pendulum, motor, friction curve, breakaway, gap."""

from math import pi

import numpy as np
import pytest
from scipy.special import ellipk

from sim_backend.second_plant import friction
from sim_backend.second_plant.controller import CLOSED
from sim_backend.second_plant.physics import Physics
from sim_backend.second_plant.simulate import TICK_S, Plan, Traces, run
from tests.second_plant.bench import CONTROL, PLAIN, open_loop, seconds
from tests.sim_backend.compiled import callable_from_python

load_loss_n_m = callable_from_python(friction.load_loss_n_m)
INERTIA = PLAIN.rotor_kg_m2 + PLAIN.arm_kg_m2


def swing(p: Physics, start_rad: float, duration: float) -> Traces:
    return run(p, CONTROL, open_loop(np.zeros(len(seconds(duration))), start_rad))


def energy(p: Physics, traces: Traces) -> np.ndarray:
    inertia = p.rotor_kg_m2 + p.arm_kg_m2
    return 0.5 * inertia * traces.speed_rad_s**2 - p.moment_n_m * np.cos(traces.reading_rad)


def period(traces: Traces) -> float:
    """Mean time between crossings of zero in the same direction."""
    angle = traces.reading_rad
    up = np.flatnonzero((angle[:-1] < 0.0) & (angle[1:] >= 0.0))
    crossed = up + angle[up] / (angle[up] - angle[up + 1])
    return float(np.mean(np.diff(crossed))) * TICK_S


@pytest.mark.parametrize("start_rad", [0.05, 1.0, 2.5])
def test_a_pendulum_without_friction_has_the_period_of_the_elliptic_integral(start_rad):
    found = period(swing(PLAIN, start_rad, 20.0))

    expected = 4.0 * np.sqrt(INERTIA / PLAIN.moment_n_m) * ellipk(np.sin(0.5 * start_rad) ** 2)
    assert found == pytest.approx(expected, rel=2e-4)


def test_without_losses_the_energy_stays():
    held = energy(PLAIN, swing(PLAIN, 2.0, 20.0))[100:]

    assert np.ptp(held) < 2e-4 * PLAIN.moment_n_m


def test_viscous_friction_takes_the_energy_that_it_dissipates():
    p = PLAIN._replace(viscous_n_m=0.05)
    traces = swing(p, 2.0, 3.0)
    held = energy(p, traces)[100:]
    lost = np.cumsum(p.viscous_n_m * traces.speed_rad_s[100:] ** 2) * TICK_S

    assert held + lost == pytest.approx(held[0], abs=2e-3 * PLAIN.moment_n_m)


def test_a_step_of_voltage_spins_the_motor_up_as_its_two_time_constants_say():
    p = PLAIN._replace(moment_n_m=0.0, inductance_h=0.02, emf_per_rad_s=2.0)
    volt = 10.0  # a voltage drive whose belief of the back-EMF is 0 holds the duty
    control = CONTROL._replace(voltage_drive=True, emf_per_rad_s=0.0)
    at = seconds(0.5)
    traces = run(p, control, open_loop(np.full(len(at), volt)))

    # L J w'' + R J w' + k k w = k u
    roots = np.roots([p.inductance_h * INERTIA, p.resistance_ohm * INERTIA, p.torque_per_a * p.emf_per_rad_s])
    ends = (at + TICK_S)[:, None]
    final = volt / p.emf_per_rad_s
    shape = (roots[1] * np.exp(roots[0] * ends) - roots[0] * np.exp(roots[1] * ends)) / (roots[0] - roots[1])
    expected = final * (1.0 + np.real(shape[:, 0]))

    assert traces.speed_rad_s == pytest.approx(expected, abs=3e-3 * final)


@pytest.mark.parametrize("power", [0.5, 1.0, 2.5])
@pytest.mark.parametrize("speed_rad_s", [0.02, 0.05, 0.1, 1.0])
def test_steady_speed_takes_the_torque_of_the_stribeck_curve(power, speed_rad_s):
    p = PLAIN._replace(
        moment_n_m=0.0, coulomb_n_m=0.5, static_n_m=0.8, stribeck_power=power, viscous_n_m=0.2,
        bristle_damping_n_m_s=2.0, bristle_rad=2e-4,
    )  # fmt: skip
    at = seconds(6.0)
    target = speed_rad_s * np.maximum(at - 0.2, 0.0)
    zero = np.zeros(len(at))
    rate = np.gradient(target, TICK_S)
    plan = Plan(np.full(len(at), CLOSED), target, rate, zero, zero, zero, zero, zero)
    # stiff: the falling part of the curve is unstable under a soft controller
    traces = run(p, CONTROL._replace(position_per_s=30.0, speed_a_s=15.0, integral_a=100.0), plan)
    late = slice(-4000, None)

    expected = 0.5 + 0.3 * np.exp(-((speed_rad_s / 0.05) ** power)) + 0.2 * speed_rad_s
    assert np.ptp(traces.speed_rad_s[late]) < 0.02 * speed_rad_s
    assert p.torque_per_a * np.mean(traces.current_a[late]) == pytest.approx(expected, rel=5e-3)


def test_the_joint_breaks_away_at_its_static_friction_and_only_bends_before():
    p = PLAIN._replace(moment_n_m=0.0, coulomb_n_m=0.5, static_n_m=0.8, stribeck_power=2.0, bristle_damping_n_m_s=1.0)
    ramp_n_m_s = 0.1
    at = seconds(12.0)
    traces = run(p, CONTROL, open_loop(ramp_n_m_s * at / p.torque_per_a))
    gone = int(np.argmax(np.abs(traces.reading_rad) > 0.02))

    assert ramp_n_m_s * at[gone] == pytest.approx(0.8, rel=0.02)
    assert np.abs(traces.reading_rad[: int(0.4 / ramp_n_m_s / TICK_S)]).max() < 2.0 * p.bristle_rad


def test_a_gear_that_loses_by_its_load_slides_smoothly_and_loses_that_share():
    p = PLAIN._replace(
        moment_n_m=0.0, spring_n_m_rad=3.0, coulomb_n_m=0.2, static_n_m=0.2, bristle_rad=2e-5,
        bristle_damping_n_m_s=20.0, tooth_loss=0.3,
    )  # fmt: skip
    at = seconds(4.0)
    target = 0.4 * np.maximum(at - 0.2, 0.0)
    zero = np.zeros(len(at))
    plan = Plan(np.full(len(at), CLOSED), target, np.gradient(target, TICK_S), zero, zero, zero, zero, zero)
    traces = run(p, CONTROL._replace(speed_a_s=10.0, integral_a=100.0), plan)
    late = slice(3000, None)

    expected = 0.2 + 1.3 * 3.0 * traces.reading_rad[late]
    assert p.torque_per_a * traces.current_a[late] == pytest.approx(expected, abs=0.03)
    assert np.std(traces.acceleration_rad_s2[late]) < 0.1


def test_a_motor_crosses_the_gap_alone_before_it_moves_the_arm():
    p = PLAIN._replace(moment_n_m=0.0, gap_rad=0.04, stiffness_n_m_rad=500.0, coupling_n_m_s=1.0)
    at = seconds(0.6)
    torque_n_m = 0.004
    traces = run(p, CONTROL, open_loop(np.full(len(at), torque_n_m / p.torque_per_a)))
    touched = int(np.argmax(traces.passed_n_m > 0.0))

    # constant torque on the rotor alone: half the gap takes sqrt(2 J x / T)
    expected = np.sqrt(2.0 * p.rotor_kg_m2 * 0.02 / torque_n_m)
    assert at[touched] == pytest.approx(expected, abs=0.005)
    assert traces.reading_rad[touched] == pytest.approx(0.02, abs=5e-4)


def test_a_rotor_that_hardly_moves_lets_the_arm_swing_at_the_antiresonance():
    p = PLAIN._replace(moment_n_m=0.0, stiffness_n_m_rad=80.0, coupling_n_m_s=0.0, rotor_kg_m2=1e3)
    traces = run(p, CONTROL, open_loop(np.full(len(seconds(3.0)), 1.0)))
    load = traces.passed_n_m - np.mean(traces.passed_n_m)
    up = np.flatnonzero((load[:-1] < 0.0) & (load[1:] >= 0.0))

    expected = 2.0 * pi / np.sqrt(80.0 / p.arm_kg_m2)
    assert np.mean(np.diff(up)) * TICK_S == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("gap_rad", [0.0, 0.02])
def test_a_joint_at_rest_begins_with_its_spring_wound_up_by_the_weight(gap_rad):
    p = PLAIN._replace(rotor_kg_m2=1e4, stiffness_n_m_rad=40.0, coupling_n_m_s=0.01, gap_rad=gap_rad)
    traces = swing(p, 0.8, 0.2)

    assert traces.passed_n_m == pytest.approx(traces.passed_n_m[0], rel=1e-3)
    assert abs(traces.passed_n_m[0]) > 0.5 * p.moment_n_m


def test_bristles_that_are_pressed_below_breakaway_do_not_creep():
    p = PLAIN._replace(moment_n_m=0.0, coulomb_n_m=0.5, static_n_m=0.5, bristle_damping_n_m_s=1.0)
    at = seconds(10.0)
    wave_n_m = 0.12 + 0.05 * np.sin(2.0 * pi * 5.0 * at)
    traces = run(p, CONTROL, open_loop(wave_n_m / p.torque_per_a))
    cycles = traces.reading_rad[2000:].reshape(-1, 400).mean(axis=1)

    assert np.ptp(cycles[20:]) < 1e-6


def test_teeth_that_drive_rub_more_than_teeth_that_hold_back():
    physics = PLAIN._replace(quadrant_n_m=0.3)
    for pulled, speed in ((1.0, 2.0), (-1.0, -2.0)):
        driving, holding = (load_loss_n_m(physics, sign * pulled, speed) for sign in (1.0, -1.0))
        assert driving - holding == pytest.approx(0.6)
        assert load_loss_n_m(PLAIN, pulled, speed) == pytest.approx(0.5 * (driving + holding))
