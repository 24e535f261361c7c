"""A plain joint for checks against solutions that need no simulation."""

import numpy as np

from sim_backend.second_plant.controller import OPEN, Control
from sim_backend.second_plant.physics import Physics
from sim_backend.second_plant.simulate import TICK_S, Plan

PLAIN = Physics(
    resistance_ohm=1.0,
    inductance_h=5e-4,
    torque_per_a=2.0,
    emf_per_rad_s=0.0,  # an open winding: the current is what is asked for
    supply_v=48.0,
    turns=50.0,
    rotor_kg_m2=0.02,
    arm_kg_m2=0.05,
    moment_n_m=2.0,
    coulomb_n_m=1e-9,
    static_n_m=1e-9,
    stribeck_rad_s=0.05,
    stribeck_power=1.0,
    viscous_n_m=0.0,
    viscous_power=1.0,
    bristle_rad=1e-3,
    bristle_damping_n_m_s=0.0,
    gear_c=25.0,
    winding_c=25.0,
    winding_j_k=1e9,
    session_s=0.0,
    load_kg=0.0,
)
CONTROL = Control(
    cascade=True,
    voltage_drive=False,
    position_per_s=10.0,
    speed_a_s=1.5,
    integral_a=8.0,
    stiffness_a_rad=20.0,
    inertia_a_s2=0.035,
    gravity_a=1.0,
    most_a=20.0,
    resistance_ohm=1.0,
    emf_per_rad_s=2.0,
    count_rad=0.0,
    speed_filter_s=1e-3,
    tether_rad=1e9,
)


def open_loop(current_a: np.ndarray, start_rad: float = 0.0) -> Plan:
    """The current of every tick, whatever the joint does."""
    zero = np.zeros(len(current_a))
    mode = np.full(len(current_a), OPEN, dtype=np.int64)
    return Plan(mode, zero + start_rad, zero, zero, current_a, zero, zero, zero)


def seconds(duration: float) -> np.ndarray:
    """Times of the ticks."""
    return np.arange(int(duration / TICK_S)) * TICK_S
