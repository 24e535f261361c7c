"""Bristle friction: three elasto-plastic elements of different stiffness share one level that depends on speed.

dz/dt = v - alpha lambda z, F = sum sigma z + sigma_1 dz/dt (Dupont, Hayward, Armstrong, Altpeter 2002; Al-Bender,
Lampaert, Swevers 2005 for the parallel elements). The bristle equation is integrated exactly over a step of constant
speed, so that it is stable however stiff the bristles are.
"""

from math import exp, log, sin

from sim_backend.second_plant.compiled import compiled
from sim_backend.second_plant.physics import REFERENCE_C, Physics

KELVIN = 273.15
SHARES = (0.5, 0.3, 0.2)  # of the level
LENGTHS = (0.4, 1.0, 3.0)  # of the pre-sliding distance
ELASTIC = 0.6  # of the breakaway deflection, below which a bristle only bends
SMOOTH_RAD_S = 0.01  # below which a power law is linear: its slope stays finite
PATH_WAVES = (1.0, 2.7, 6.3, 15.1)  # per radian of the joint


@compiled
def level_n_m(p: Physics, speed: float, time_s: float, dwell_n_m: float, breakaway: float) -> float:
    """Level of the friction over speed, before what the place and the load add [N m].

    Args:
        p: the joint.
        speed: rad/s.
        time_s: since the trial began.
        dwell_n_m: what rest has added to the static level.
        breakaway: factor of the static level, for the rate of the torque.
    """
    size = abs(speed)
    film = exp(-((size / p.stribeck_rad_s) ** p.stribeck_power))
    bump = (p.static_n_m * breakaway - p.coulomb_n_m + dwell_n_m) * film
    step = p.second_level / (1.0 + exp(-4.0 * (size / p.second_rad_s - 1.0))) if p.second_level != 0.0 else 0.0
    warm = 1.0 + p.coulomb_per_k * (p.gear_c - REFERENCE_C)
    if p.warm_up != 0.0:
        warm += p.warm_up * exp(-(p.session_s + time_s) / p.warm_up_s)
    return max((p.coulomb_n_m * (1.0 + step) + bump) * warm, 0.05 * p.coulomb_n_m)


@compiled
def place_factor(p: Physics, angle: float) -> float:
    """Factor of the level at a place, the same at each pass: scatter along the path."""
    factor = 1.0
    if p.path_scatter != 0.0:
        for order in range(4):
            factor += 0.7 * p.path_scatter * sin(PATH_WAVES[order] * angle + p.path_phase_rad * (order + 1))
    return factor


@compiled
def load_loss_n_m(p: Physics, transmitted: float, speed: float) -> float:
    """What the tooth-normal force and the bearing force add to the level [N m]."""
    size = abs(transmitted)
    added = p.tooth_loss * size + p.tooth_loss_square_1_n_m * size * size + p.bearing_loss_n_m_kg * p.load_kg
    if p.back_driving_loss != 0.0 and transmitted * speed < 0.0:
        added += p.back_driving_loss * size
    if p.quadrant_n_m != 0.0:
        added += p.quadrant_n_m if transmitted * speed > 0.0 else -p.quadrant_n_m
    return added


@compiled
def flow_n_m(p: Physics, speed: float) -> float:
    """Viscous friction, linear or of another power, with or without shear thinning; and drag [N m]."""
    torque = p.viscous_n_m * speed
    if p.viscous_power != 1.0:
        torque *= (speed * speed + SMOOTH_RAD_S * SMOOTH_RAD_S) ** (0.5 * (p.viscous_power - 1.0))
    if p.film_rad_s > 0.0:
        torque /= 1.0 + abs(speed) / p.film_rad_s
    if p.lubricant_k != 0.0:
        torque *= exp(p.lubricant_k * (1.0 / (p.gear_c + KELVIN) - 1.0 / (REFERENCE_C + KELVIN)))
    if p.viscous_asymmetry != 0.0:
        torque *= 1.0 + (p.viscous_asymmetry if speed > 0.0 else -p.viscous_asymmetry)
    return torque + p.drag_n_m_s2 * speed * abs(speed)


@compiled
def bent(bristle: float, speed: float, breakaway_rad: float, step_s: float) -> float:
    """Deflection of a bristle after a step at constant speed [rad]."""
    plastic = 0.0
    ratio = bristle / breakaway_rad if speed > 0.0 else -bristle / breakaway_rad
    if ratio >= 1.0:
        plastic = 1.0
    elif ratio > ELASTIC:
        plastic = (ratio - ELASTIC) / (1.0 - ELASTIC)
    rate = plastic * abs(speed) / breakaway_rad
    if rate * step_s < 1e-9:
        return bristle + speed * step_s
    fade = exp(-rate * step_s)
    return bristle * fade + speed * (1.0 - fade) / rate


@compiled
def rested_n_m(p: Physics, rest_s: float) -> float:
    """What a rest adds to the static level: with the logarithm of its length (Rabinowicz 1958) [N m]."""
    return p.dwell_n_m * log(1.0 + rest_s / p.dwell_s)
