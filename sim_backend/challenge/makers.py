"""Plant tables that make each mechanism of a size, fitted to the joint that it is hidden in."""

from collections.abc import Callable

import numpy as np

from sim_backend.challenge.joint import Joint, Tables
from sim_backend.challenge.ranges import SESSION_S
from sim_backend.mechanisms.joint.gravity import STANDARD_GRAVITY_M_S2

Make = Callable[[float, Joint, np.random.Generator], Tables]
"""(size, joint, generator) -> plant tables that differ from the joint's own."""


def either_way(size: float, random: np.random.Generator) -> float:
    """A size with a sign drawn for it."""
    return size if random.random() < 0.5 else -size


def one(component: str, parameter: str) -> Make:
    """A size that is the parameter itself."""
    return lambda size, _joint, _random: {component: {parameter: size}}


def signed(component: str, parameter: str) -> Make:
    """A size that is the parameter itself, either way."""
    return lambda size, _joint, random: {component: {parameter: either_way(size, random)}}


def drag(size: float, joint: Joint, _random: np.random.Generator) -> Tables:
    """The size is the drag at top speed over Coulomb friction."""
    top_rad_s = joint.top_rad_s * joint.ratio
    return {"drag": {"coefficient_n_m_s2_rad2": size * joint.coulomb_n_m / joint.ratio / top_rad_s**2}}


def periodic(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is a share of dry friction; three to twelve cycles a turn."""
    cycles, phase_rad = int(random.integers(3, 13)), float(random.uniform(-np.pi, np.pi))
    return {"periodic_friction": {"fraction": size, "cycles_per_turn": float(cycles), "phase_rad": phase_rad}}


def run_in(size: float, joint: Joint, random: np.random.Generator) -> Tables:
    """The size is a share of dry friction, gone within the protocol."""
    way_rad = 0.4 * joint.top_rad_s * joint.ratio * SESSION_S  # of the motor, over the protocol
    return {"run_in": {"fraction": size, "distance_rad": float(random.uniform(0.15, 0.5)) * way_rad}}


def spring(size: float, joint: Joint, random: np.random.Generator) -> Tables:
    """The size is the torque at one radian over gravity."""
    return {"spring": {"stiffness_n_m_rad": size * joint.gravity_n_m, "rest_rad": float(random.uniform(-0.5, 0.5))}}


def cogging(size: float, joint: Joint, random: np.random.Generator) -> Tables:
    """The size is the amplitude over Coulomb friction, at the joint."""
    cycles = float(random.choice([4.0, 6.0, 8.0, 12.0]))
    phase_rad = float(random.uniform(-np.pi, np.pi))
    amplitude = size * joint.coulomb_n_m / joint.ratio
    return {"cogging": {"amplitude_n_m": amplitude, "cycles_per_turn": cycles, "phase_rad": phase_rad}}


def drift(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is the growth of resistance; magnets weaken by less."""
    return {
        "thermal_drift": {"resistance_per_k": size, "torque_constant_per_k": float(random.uniform(0.1, 0.5)) * size}
    }


def eccentricity(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is the angle at the motor."""
    return {"eccentricity": {"amplitude_rad": size, "phase_rad": float(random.uniform(-np.pi, np.pi))}}


def mesh(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is the loss while driving; driven back it is no more."""
    return {"load_friction": {"driving": size, "back_driving": float(random.uniform(0.6, 1.0)) * size}}


def weight(size: float, joint: Joint, _random: np.random.Generator) -> Tables:
    """The size is the growth under the heaviest load."""
    return {"friction": {"growth_per_n": size / (STANDARD_GRAVITY_M_S2 * joint.heaviest_kg)}}


def bristle(size: float, joint: Joint, _random: np.random.Generator) -> Tables:
    """The size is the joint angle before friction slips."""
    friction = joint.tables["friction"]
    stiffness = friction["static_n_m"] / (size * joint.ratio)
    damping = 0.4 * friction["coulomb_n_m"] / friction["stribeck_rad_s"]
    return {"bristle": {"stiffness_n_m_rad": stiffness, "damping_n_m_s_rad": damping}}


def dwell(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is a share of static friction."""
    return {"dwell": {"rise_fraction": size, "time_s": float(random.uniform(0.3, 2.0))}}


def shaft(size: float, joint: Joint, _random: np.random.Generator) -> Tables:
    """The size is the twist at peak torque."""
    return {"shaft": {"compliance_rad_n_m": size / joint.peak_n_m}}


def clutch(size: float, joint: Joint, _random: np.random.Generator) -> Tables:
    """The size is by how much gravity exceeds what the clutch holds."""
    return {"clutch": {"limit_n_m": joint.gravity_n_m / (1.0 + size)}}


def hose(size: float, joint: Joint, random: np.random.Generator) -> Tables:
    """The size is the most drag over Coulomb friction."""
    reach_rad = float(random.uniform(0.2, 0.7))
    return {"hose": {"stiffness_n_m_rad": size * joint.coulomb_n_m / (2.0 / 3.0 * reach_rad), "reach_rad": reach_rad}}


def jump(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is a share of dry friction."""
    return {"friction_jump": {"fraction": size, "mean_interval_s": float(random.uniform(2.0, 6.0))}}


def ripple(size: float, _joint: Joint, random: np.random.Generator) -> Tables:
    """The size is a share of the voltage."""
    return {"supply_ripple": {"fraction": size, "frequency_hz": float(random.uniform(0.3, 3.0))}}
