"""Every constant of the joint, as the compiled equations of motion read them.

Angles, torques and inertias are at the joint: a motor angle is divided by the gear ratio, a rotor inertia multiplied by
its square. A constant of a mechanism that the joint does not have is 0.
"""

from typing import NamedTuple

GRAVITY_M_S2 = 9.80665
REFERENCE_C = 25.0  # temperature at which resistance, lubricant and torque constant are stated


class Physics(NamedTuple):
    """One joint under the conditions of one trial."""

    # PM motor and power stage: L di/dt = u - R i - k_e omega, torque k_t i
    resistance_ohm: float
    inductance_h: float
    torque_per_a: float  # N m of the joint per A, gear ratio included
    emf_per_rad_s: float  # V per rad/s of the joint
    supply_v: float
    turns: float  # motor turns per joint turn
    # rotor, arm and tip load in a vertical plane, angle 0 hanging down
    rotor_kg_m2: float
    arm_kg_m2: float
    moment_n_m: float  # weight of arm and load at 90 degrees
    # friction: level of the bristles over speed, and what flows
    coulomb_n_m: float
    static_n_m: float
    stribeck_rad_s: float
    stribeck_power: float
    viscous_n_m: float  # at 1 rad/s
    viscous_power: float
    bristle_rad: float
    bristle_damping_n_m_s: float
    gear_c: float
    winding_c: float
    winding_j_k: float  # heat capacity
    session_s: float  # time since the bench was switched on, at the start of the trial
    load_kg: float
    # laws that no textbook formula of the lab states
    film_rad_s: float = 0.0  # viscous torque saturates above (shear thinning)
    second_level: float = 0.0  # share by which the Coulomb level changes above second_rad_s
    second_rad_s: float = 1.0
    path_scatter: float = 0.0  # of the friction level, along the path
    path_phase_rad: float = 0.0
    # mechanisms that textbooks on servo drives name
    coulomb_asymmetry: float = 0.0
    viscous_asymmetry: float = 0.0
    drag_n_m_s2: float = 0.0
    tooth_loss: float = 0.0  # share of the transmitted torque
    tooth_loss_square_1_n_m: float = 0.0
    bearing_loss_n_m_kg: float = 0.0
    back_driving_loss: float = 0.0
    quadrant_n_m: float = 0.0
    coulomb_per_k: float = 0.0
    lubricant_k: float = 0.0  # Arrhenius: viscosity ~ exp(B (1/T - 1/T0))
    warm_up: float = 0.0
    warm_up_s: float = 1.0
    periodic_share: float = 0.0
    periodic_phase_rad: float = 0.0
    cogging_n_m: float = 0.0
    cogging_per_turn: float = 1.0
    spring_n_m_rad: float = 0.0
    spring_zero_rad: float = 0.0
    centre_rad: float = 0.0
    saturation_a: float = 0.0
    copper_per_k: float = 0.0
    gap_rad: float = 0.0
    stiffness_n_m_rad: float = 0.0  # 0: gear and shaft are rigid
    coupling_n_m_s: float = 0.0
    lag_s: float = 0.0
    dwell_n_m: float = 0.0  # per e-fold of the time at rest
    dwell_s: float = 0.1
    rate_share: float = 0.0
    rate_n_m_s: float = 1.0
    eccentricity_rad: float = 0.0  # of the motor shaft, divided by the gear ratio
    dead_time_v: float = 0.0
    source_ohm: float = 0.0
    current_gain: float = 0.0  # of the sensor, positive against negative current
    # mechanisms that no catalogue of the lab names
    hysteresis_n_m: float = 0.0
    hysteresis_rad: float = 1.0
    seal_n_m: float = 0.0
    seal_rad: float = 1.0
    seal_s: float = 1.0
    tooth_impact_n_m: float = 0.0  # per rad/s of the joint
    teeth_per_turn: float = 1.0
    cable_kg_m: float = 0.0  # mass times lever arm
    cable_rad_s: float = 1.0
    other_axis_v: float = 0.0
    creep_per_s: float = 0.0  # belt slip of the arm, in rad/s per N m of belt tension
    interpolation_rad: float = 0.0
    interpolation_order: float = 1.0
    housing_n_m: float = 0.0
    housing_s: float = 1.0
    ripple_share: float = 0.0
    pole_pairs: float = 1.0
    sector_n_m: float = 0.0
    sector_rad: float = 0.0
    sector_width_rad: float = 1.0
    tip_kg_m2: float = 0.0
    tip_rad_s: float = 1.0
    acceleration_loss: float = 0.0  # s^2/rad: share of the level per rad/s^2
    bias_a: float = 0.0  # of the current sensor, standard deviation of its walk
    bias_s: float = 1.0
    rub_n_m: float = 0.0
    rub_s: float = 1.0
    torque_step_n_m: float = 0.0  # for tests: constant torque on the motor side
