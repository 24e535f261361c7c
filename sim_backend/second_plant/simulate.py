"""One trial of the joint in fine steps: power stage, current, bristles, motion, and the drive's controller between."""

from collections.abc import Callable
from math import exp, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim_backend.second_plant.compiled import SOURCES, compiled, compiled_and_kept
from sim_backend.second_plant.contact import friction_n_m, moment_of, note_step, resting
from sim_backend.second_plant.controller import Control, Loop, asked, encoder, measured
from sim_backend.second_plant.motion import Places, Speeds, drifted, kicked, resting_at
from sim_backend.second_plant.motor import motor_n_m, power_stage, sensed, winding_ohm
from sim_backend.second_plant.physics import Physics

FloatArray = NDArray[np.float64]
TICK_S, STEPS = 5e-4, 10  # period of the controller, and steps of the physics in it (20 kHz)
CURRENT_LOOP_RAD_S = 2500.0
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
    """Simulate one trial from rest at the first target."""
    traces = np.zeros((TRACES, len(plan.mode)))
    _kept_run(p, control, plan, traces)
    return Traces(*traces)


@compiled
def _run(p: Physics, control: Control, plan: Plan, traces: FloatArray) -> None:
    step_s = TICK_S / STEPS
    start = plan.target_rad[0]
    at, speeds = resting_at(p, start), Speeds(0.0, 0.0, 0.0, 0.0)
    interpolation = (p.interpolation_rad, p.interpolation_order, p.pole_pairs)
    reading = encoder(p.turns, control.count_rad, start, p.eccentricity_rad, interpolation)
    # the joint is held at the start, so the integral begins at what holds the weight
    held_a = (p.moment_n_m * sin(start) + p.spring_n_m_rad * (start - p.spring_zero_rad)) / p.torque_per_a
    loop = Loop(reading, 0.0, held_a if control.cascade else 0.0, reading, False, 0.0)
    current, winding_c, passed, acceleration = held_a, p.winding_c, p.torque_per_a * held_a, 0.0
    contact = resting(passed)
    duty_v, integral_v, bus = p.resistance_ohm * held_a, p.resistance_ohm * held_a, p.supply_v
    for tick in range(len(plan.mode)):
        reading = encoder(p.turns, control.count_rad, at.rotor, p.eccentricity_rad, interpolation)
        loop = measured(control, loop, reading, TICK_S)
        wanted = (plan.target_rad[tick], plan.speed_rad_s[tick], plan.acceleration_rad_s2[tick], plan.open_a[tick])
        asked_a, loop = asked(control, loop, plan.mode[tick], wanted, TICK_S)
        if control.voltage_drive:
            duty_v = control.resistance_ohm * asked_a + control.emf_per_rad_s * loop.speed_rad_s
        ohm = winding_ohm(p, winding_c)
        fade = exp(-step_s * ohm / p.inductance_h)
        bias_a = p.bias_a * plan.walk[tick]
        moment = moment_of(p, contact, at.rotor, tick * TICK_S, plan.telegraph[tick])
        sensed_a = 0.0
        for _ in range(STEPS):
            # electrical side, exact for a constant voltage over the step
            sensed_a = sensed(p, current, bias_a)
            if not control.voltage_drive:
                off_a = asked_a - sensed_a
                integral_v += CURRENT_LOOP_RAD_S * p.resistance_ohm * off_a * step_s
                integral_v = min(max(integral_v, -p.supply_v), p.supply_v)
                duty_v = CURRENT_LOOP_RAD_S * p.inductance_h * off_a + integral_v
            volt, bus = power_stage(p, duty_v, current, plan.other_axis[tick])
            settled = (volt - p.emf_per_rad_s * speeds.rotor) / ohm
            current = settled + (current - settled) * fade
            v = speeds.rotor
            friction = friction_n_m(p, contact, at.rotor, v, moment, step_s)
            torque = motor_n_m(p, current, at.rotor)
            at = drifted(at, speeds, 0.5 * step_s)
            speeds, acceleration, passed = kicked(p, at, speeds, torque - friction, step_s)
            at = drifted(at, speeds, 0.5 * step_s)
            if p.creep_per_s != 0.0:
                at = Places(at.rotor, at.arm - p.creep_per_s * passed * step_s, at.tip, at.cable)
            note_step(p, contact, v, torque, passed, acceleration, step_s)
        winding_c += TICK_S * ohm * current * current / p.winding_j_k
        traces[0, tick] = encoder(p.turns, 0.0, at.rotor, p.eccentricity_rad, interpolation)
        traces[1, tick] = sensed_a
        traces[2, tick] = duty_v / p.supply_v
        traces[3, tick] = bus
        traces[4, tick] = winding_c
        traces[5, tick] = speeds.rotor
        traces[6, tick] = acceleration
        traces[7, tick] = passed


def _run_of(sources: int) -> Callable[[Physics, Control, Plan, FloatArray], None]:
    def kept_run(p: Physics, control: Control, plan: Plan, traces: FloatArray) -> None:
        sources  # noqa: B018  (part of the key)
        _run(p, control, plan, traces)

    return compiled_and_kept(kept_run)


_kept_run = _run_of(SOURCES)
