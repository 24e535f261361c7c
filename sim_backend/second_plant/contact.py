"""What rubs in a step, and what it remembers: bristles, lagging levels, seal, and the rest before a start."""

from math import exp, floor, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim_backend.second_plant.compiled import compiled
from sim_backend.second_plant.friction import LENGTHS, SHARES, bent, level_n_m, load_loss_n_m, place_factor, rested_n_m
from sim_backend.second_plant.motion import seal_n_m
from sim_backend.second_plant.physics import Physics

REST_RAD_S = 2e-3
CONTACT_S = 2e-3  # in which the friction level follows the force between the teeth
RATE_S = 0.05  # over which the rate of the torque is taken
ELEMENTS = (0.1, 0.25, 0.5, 1.0)  # slip lengths of the hysteresis, as shares of the longest
LAGGED, SEAL, PRESSED, SHAKEN, REST, RATE, SLOW = range(7)  # places in `Contact.memory`


class Contact(NamedTuple):
    """What friction remembers; arrays that a step changes in place."""

    bristles: NDArray[np.float64]  # deflections [rad], shape (3,)
    longer: NDArray[np.float64]  # of the hysteresis [rad], shape (4,)
    memory: NDArray[np.float64]  # shape (7,): see the names above


class Moment(NamedTuple):
    """What holds for a tick: factors of the level, and what is added to it [N m]."""

    time_s: float
    breakaway: float
    dwell_n_m: float
    place: float
    added_n_m: float


@compiled
def resting(torque_n_m: float) -> Contact:
    """At rest for a second, with the motor's torque against the teeth."""
    memory = np.zeros(7)
    memory[PRESSED], memory[SLOW], memory[REST] = torque_n_m, torque_n_m, 1.0
    return Contact(np.zeros(3), np.zeros(4), memory)


@compiled
def moment_of(p: Physics, contact: Contact, angle: float, time_s: float, rub: float) -> Moment:
    """What holds for the next tick.

    Args:
        p: the joint.
        contact: as it is.
        angle: of the rotor [rad].
        time_s: since the trial began.
        rub: 0 or 1, whether something rubs.
    """
    breakaway = 1.0
    if p.rate_share != 0.0:
        rate = max(contact.memory[RATE], 1e-9)
        breakaway = min(max(1.0 - p.rate_share * np.log10(rate / p.rate_n_m_s), 0.6), 1.6)
    dwell_n_m = rested_n_m(p, contact.memory[REST]) if p.dwell_n_m != 0.0 else 0.0
    added_n_m = _added_n_m(p, angle, p.session_s + time_s, rub)
    return Moment(time_s, breakaway, dwell_n_m, place_factor(p, angle), added_n_m)


@compiled
def friction_n_m(p: Physics, contact: Contact, angle: float, v: float, moment: Moment, step_s: float) -> float:
    """What rubs over a step at constant speed v [rad/s]: the level, and the bristles that carry it."""
    memory, bristles, longer = contact.memory, contact.bristles, contact.longer
    memory[LAGGED] = memory[LAGGED] + (v - memory[LAGGED]) * (1.0 - exp(-step_s / p.lag_s)) if p.lag_s > 0.0 else v
    level = level_n_m(p, memory[LAGGED], moment.time_s, moment.dwell_n_m, moment.breakaway)
    level = (level + load_loss_n_m(p, memory[PRESSED], v) + moment.added_n_m) * moment.place
    if p.periodic_share != 0.0:
        level *= 1.0 + p.periodic_share * sin(angle * p.turns + p.periodic_phase_rad)
    level *= 1.0 + (p.coulomb_asymmetry if v > 0.0 else -p.coulomb_asymmetry)
    if p.acceleration_loss != 0.0:
        level *= 1.0 + p.acceleration_loss * min(abs(memory[SHAKEN]), 100.0)
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
        memory[SEAL] += step_s * (v - memory[SEAL] / p.seal_s)
        friction += seal_n_m(p, memory[SEAL])
    return friction + _impact_n_m(p, angle, v)


@compiled
def note_step(
    p: Physics, contact: Contact, v: float, torque: float, passed: float, acceleration: float, step_s: float
) -> None:
    """Remember a step: the motor's torque, what was passed on to the arm [N m], the acceleration [rad/s^2]."""
    memory, follow = contact.memory, step_s / CONTACT_S
    memory[PRESSED] += follow * (passed - memory[PRESSED])
    memory[SHAKEN] += follow * (acceleration - memory[SHAKEN])
    if p.rate_share != 0.0 and abs(v) < REST_RAD_S:
        memory[RATE] = abs(torque - memory[SLOW]) / RATE_S
    memory[SLOW] += (torque - memory[SLOW]) * step_s / RATE_S
    if abs(v) < REST_RAD_S:
        memory[REST] += step_s
    elif abs(v) > p.stribeck_rad_s:
        memory[REST] = 0.0


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
