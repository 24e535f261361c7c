"""One trial of the joint in fine steps: power stage, current, bristles, motion, and the drive's controller between."""

from math import cos, exp, floor, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim_backend.second_plant.compiled import compiled
from sim_backend.second_plant.controller import Control, Loop, asked, encoder, measured
from sim_backend.second_plant.friction import LENGTHS, SHARES, bent, level_n_m, load_loss_n_m, place_factor, rested_n_m
from sim_backend.second_plant.motion import Places, Speeds, drifted, kicked, seal_n_m
from sim_backend.second_plant.physics import REFERENCE_C, Physics

FloatArray = NDArray[np.float64]
TICK_S, STEPS = 5e-4, 10  # period of the controller, and steps of the physics in it (20 kHz)
CURRENT_LOOP_RAD_S = 2500.0
REST_RAD_S = 2e-3
CONTACT_S = 2e-3  # in which the friction level follows the force between the teeth
RATE_S = 0.05  # over which the rate of the torque is taken
ELEMENTS = (0.1, 0.25, 0.5, 1.0)  # slip lengths of the hysteresis, as shares of the longest
TRACES = 8


class Traces(NamedTuple):
    """What truly was, at every tick; arrays of shape (ticks,)."""

    reading_rad: FloatArray  # of an encoder without counts
    current_a: FloatArray  # as the sensor gives it, without noise
    duty: FloatArray
    supply_v: FloatArray
    winding_c: FloatArray
    speed_rad_s: FloatArray
    acceleration_rad_s2: FloatArray
    passed_n_m: FloatArray


class Plan(NamedTuple):
    """What is asked of the joint at every tick; arrays of shape (ticks,)."""

    mode: NDArray[np.int64]
    target_rad: FloatArray
    speed_rad_s: FloatArray
    acceleration_rad_s2: FloatArray
    open_a: FloatArray
    walk: FloatArray  # a random walk that comes back, of unit deviation
    telegraph: FloatArray  # 0 or 1
    other_axis: FloatArray  # load of the other axis on the supply, 0 or 1


def run(p: Physics, control: Control, plan: Plan) -> Traces:
    """Simulate one trial from rest at the first target.

    Args:
        p: the joint under the trial's conditions.
        control: of the drive.
        plan: of the trial.
    """
    traces = np.zeros((TRACES, len(plan.mode)))
    _run(p, control, plan, traces)
    return Traces(*traces)


@compiled
def _power_stage(p: Physics, asked_v: float, current: float, busy: float) -> tuple[float, float]:
    """Voltage at the motor and of the supply."""
    duty = asked_v / p.supply_v
    bus = p.supply_v - p.source_ohm * abs(current * duty) - p.other_axis_v * busy
    duty = min(max(duty, -1.0), 1.0)
    return duty * bus - p.dead_time_v * min(max(current / (0.02 * p.supply_v / p.resistance_ohm), -1.0), 1.0), bus


@compiled
def _motor_n_m(p: Physics, current: float, angle: float) -> float:
    """Torque of the motor, with saturation, ripple and commutation off by the sensor's error."""
    constant = p.torque_per_a
    if p.saturation_a > 0.0:
        constant /= 1.0 + (current / p.saturation_a) ** 2
    motor = angle * p.turns
    if p.ripple_share != 0.0:
        constant *= 1.0 + p.ripple_share * sin(6.0 * p.pole_pairs * motor)
    if p.interpolation_rad != 0.0:
        off = p.interpolation_rad * p.turns * sin(p.interpolation_order * p.pole_pairs * motor + 0.25 * pi)
        constant *= cos(p.pole_pairs * off)
    torque = constant * current + p.torque_step_n_m
    if p.cogging_n_m != 0.0:
        torque -= p.cogging_n_m * sin(p.cogging_per_turn * motor)
    return torque


@compiled
def _added_n_m(p: Physics, angle: float, session_s: float, rub: float) -> float:
    """What mechanisms outside any textbook's list add to the level of the friction."""
    added = p.rub_n_m * rub
    if p.housing_n_m != 0.0:
        added += 0.5 * p.housing_n_m * (1.0 + sin(2.0 * pi * session_s / p.housing_s))
    if p.sector_n_m != 0.0:
        off = (angle - p.sector_rad) / p.sector_width_rad
        added += p.sector_n_m * exp(-off * off)
    return added


@compiled
def _impact_n_m(p: Physics, angle: float, speed: float) -> float:
    """Braking torque while a tooth comes into mesh: a short pulse once a tooth, with the speed of impact."""
    if p.tooth_impact_n_m == 0.0:
        return 0.0
    phase = angle * p.teeth_per_turn / (2.0 * pi)
    off = (phase - floor(phase) - 0.5) / 0.06
    return p.tooth_impact_n_m * speed * exp(-off * off)


@compiled
def _run(p: Physics, control: Control, plan: Plan, traces: FloatArray) -> None:  # noqa: C901 - one compiled loop
    step_s = TICK_S / STEPS
    start = plan.target_rad[0]
    at, speeds = Places(start, start, start, 0.0), Speeds(0.0, 0.0, 0.0, 0.0)
    interpolation = (p.interpolation_rad, p.interpolation_order, p.pole_pairs)
    reading = encoder(p.turns, control.count_rad, start, p.eccentricity_rad, interpolation)
    # the joint is held at the start, so the integral begins at what holds the weight
    held_a = (p.moment_n_m * sin(start) + p.spring_n_m_rad * (start - p.spring_zero_rad)) / p.torque_per_a
    loop = Loop(reading, 0.0, held_a if control.cascade else 0.0, reading, False, 0.0)
    current, winding_c, passed, acceleration = held_a, p.winding_c, p.torque_per_a * held_a, 0.0
    bristles, longer = np.zeros(3), np.zeros(4)
    lagged, rest_s, seal, slow_n_m, rate = 0.0, 1.0, 0.0, p.torque_per_a * held_a, 0.0
    pressed_n_m, shaken, follow = passed, 0.0, step_s / CONTACT_S
    duty_v, integral_v, bus = p.resistance_ohm * held_a, p.resistance_ohm * held_a, p.supply_v
    for tick in range(len(plan.mode)):
        reading = encoder(p.turns, control.count_rad, at.rotor, p.eccentricity_rad, interpolation)
        loop = measured(control, loop, reading, TICK_S)
        wanted = (plan.target_rad[tick], plan.speed_rad_s[tick], plan.acceleration_rad_s2[tick], plan.open_a[tick])
        asked_a, loop = asked(control, loop, plan.mode[tick], wanted, TICK_S)
        if control.voltage_drive:
            duty_v = control.resistance_ohm * asked_a + control.emf_per_rad_s * loop.speed_rad_s
        ohm = p.resistance_ohm * (1.0 + p.copper_per_k * (winding_c - REFERENCE_C))
        fade = exp(-step_s * ohm / p.inductance_h)
        bias_a = p.bias_a * plan.walk[tick]
        time_s = tick * TICK_S
        breakaway = 1.0
        if p.rate_share != 0.0:
            breakaway = min(max(1.0 - p.rate_share * np.log10(max(rate, 1e-9) / p.rate_n_m_s), 0.6), 1.6)
        dwell_n_m = rested_n_m(p, rest_s) if p.dwell_n_m != 0.0 else 0.0
        place, added_n_m = (
            place_factor(p, at.rotor),
            _added_n_m(p, at.rotor, p.session_s + time_s, plan.telegraph[tick]),
        )
        sensed_a = 0.0
        for _ in range(STEPS):
            # electrical side, exact for a constant voltage over the step
            sensed_a = current * (1.0 + (p.current_gain if current > 0.0 else -p.current_gain)) + bias_a
            if not control.voltage_drive:
                off_a = asked_a - sensed_a
                integral_v += CURRENT_LOOP_RAD_S * p.resistance_ohm * off_a * step_s
                integral_v = min(max(integral_v, -p.supply_v), p.supply_v)
                duty_v = CURRENT_LOOP_RAD_S * p.inductance_h * off_a + integral_v
            volt, bus = _power_stage(p, duty_v, current, plan.other_axis[tick])
            settled = (volt - p.emf_per_rad_s * speeds.rotor) / ohm
            current = settled + (current - settled) * fade
            # friction level, and the bristles that carry it
            v = speeds.rotor
            lagged = lagged + (v - lagged) * (1.0 - exp(-step_s / p.lag_s)) if p.lag_s > 0.0 else v
            level = level_n_m(p, lagged, time_s, dwell_n_m, breakaway) + load_loss_n_m(p, pressed_n_m, v)
            level = (level + added_n_m) * place
            if p.periodic_share != 0.0:
                level *= 1.0 + p.periodic_share * sin(at.rotor * p.turns + p.periodic_phase_rad)
            level *= 1.0 + (p.coulomb_asymmetry if v > 0.0 else -p.coulomb_asymmetry)
            if p.acceleration_loss != 0.0:
                level *= 1.0 + p.acceleration_loss * min(abs(shaken), 100.0)
            damping = p.bristle_damping_n_m_s * exp(-((v / p.stribeck_rad_s) ** 2))  # Olsson 1996: of slow motion alone
            friction = 0.0
            for one in range(3):
                length = LENGTHS[one] * p.bristle_rad
                stiffness = SHARES[one] * p.coulomb_n_m / length
                after = bent(bristles[one], v, SHARES[one] * level / stiffness, step_s)
                rate_of = (after - bristles[one]) / step_s
                friction += stiffness * 0.5 * (after + bristles[one]) + SHARES[one] * damping * rate_of
                bristles[one] = after
            if p.hysteresis_n_m != 0.0:
                for one in range(4):
                    most = ELEMENTS[one] * p.hysteresis_rad
                    longer[one] = min(max(longer[one] + v * step_s, -most), most)
                    friction += 0.25 * p.hysteresis_n_m * longer[one] / most
            if p.seal_n_m != 0.0:
                seal += step_s * (v - seal / p.seal_s)
                friction += seal_n_m(p, seal)
            friction += _impact_n_m(p, at.rotor, v)
            # motion
            torque = _motor_n_m(p, current, at.rotor)
            at = drifted(at, speeds, 0.5 * step_s)
            speeds, acceleration, passed = kicked(p, at, speeds, torque - friction, step_s)
            at = drifted(at, speeds, 0.5 * step_s)
            pressed_n_m += follow * (passed - pressed_n_m)
            shaken += follow * (acceleration - shaken)
            if p.creep_per_s != 0.0:
                at = Places(at.rotor, at.arm - p.creep_per_s * passed * step_s, at.tip, at.cable)
            if p.rate_share != 0.0 and abs(v) < REST_RAD_S:
                rate = abs(torque - slow_n_m) / RATE_S
            slow_n_m += (torque - slow_n_m) * step_s / RATE_S
            if abs(v) < REST_RAD_S:
                rest_s += step_s
            elif abs(v) > p.stribeck_rad_s:
                rest_s = 0.0
        winding_c += TICK_S * ohm * current * current / p.winding_j_k
        traces[0, tick] = encoder(p.turns, 0.0, at.rotor, p.eccentricity_rad, interpolation)
        traces[1, tick] = sensed_a
        traces[2, tick] = duty_v / p.supply_v
        traces[3, tick] = bus
        traces[4, tick] = winding_c
        traces[5, tick] = speeds.rotor
        traces[6, tick] = acceleration
        traces[7, tick] = passed
