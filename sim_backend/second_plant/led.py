"""What a joint that hides nothing needs to move as another one moved: the same motion, its own effort.

Two joints that differ in one mechanism do not move alike, and stick and break away at other moments. Over one motion,
what differs between their efforts is the mechanism's own share, and nothing else (inverse dynamics).
"""

from collections.abc import Callable
from math import sin

import numpy as np

from sim_backend.second_plant.compiled import SOURCES, compiled, compiled_and_kept
from sim_backend.second_plant.contact import friction_n_m, moment_of, note_step, resting
from sim_backend.second_plant.friction import flow_n_m
from sim_backend.second_plant.physics import Physics
from sim_backend.second_plant.simulate import STEPS, TICK_S, TRACES, FloatArray, Traces


def led(p: Physics, reading_rad: FloatArray) -> Traces:
    """Lead a joint along a motion.

    Args:
        p: a joint that hides nothing, under the trial's conditions: rigid, driven without loss.
        reading_rad: what an encoder without counts shows at every tick, shape (ticks,).
    """
    traces = np.zeros((TRACES, len(reading_rad)))
    _kept_led(p, reading_rad, traces)
    return Traces(*traces)


@compiled
def _led(p: Physics, reading_rad: FloatArray, traces: FloatArray) -> None:
    step_s, ticks = TICK_S / STEPS, len(reading_rad)
    angle = reading_rad[0]
    held_n_m = p.moment_n_m * sin(angle)
    contact, current, winding_c = resting(held_n_m), held_n_m / p.torque_per_a, p.winding_c
    for tick in range(ticks):
        # in a tick the speed is even, so that bristles bend as far as the joint has moved
        v = (reading_rad[tick] - reading_rad[max(tick - 1, 0)]) / TICK_S
        next_v = (reading_rad[min(tick + 1, ticks - 1)] - reading_rad[tick]) / TICK_S
        acceleration, speed = (next_v - v) / TICK_S, 0.5 * (v + next_v)
        moment = moment_of(p, contact, angle, tick * TICK_S, 0.0)
        torque = passed = 0.0
        for _ in range(STEPS):
            friction = friction_n_m(p, contact, angle, v, moment, step_s)
            angle += step_s * v
            passed = p.moment_n_m * sin(angle) + p.arm_kg_m2 * acceleration
            torque = p.rotor_kg_m2 * acceleration + flow_n_m(p, v) + passed + friction
            note_step(p, contact, v, torque, passed, acceleration, step_s)
        before, current = current, torque / p.torque_per_a
        volt = p.inductance_h * (current - before) / TICK_S + p.resistance_ohm * current + p.emf_per_rad_s * speed
        winding_c += TICK_S * p.resistance_ohm * current * current / p.winding_j_k
        traces[0, tick] = reading_rad[tick]
        traces[1, tick] = current
        traces[2, tick] = volt / p.supply_v
        traces[3, tick] = p.supply_v
        traces[4, tick] = winding_c
        traces[5, tick] = speed
        traces[6, tick] = acceleration
        traces[7, tick] = passed


def _led_of(sources: int) -> Callable[[Physics, FloatArray, FloatArray], None]:
    def kept_led(p: Physics, reading_rad: FloatArray, traces: FloatArray) -> None:
        sources  # noqa: B018  (part of the key)
        _led(p, reading_rad, traces)

    return compiled_and_kept(kept_led)


_kept_led = _led_of(SOURCES)
