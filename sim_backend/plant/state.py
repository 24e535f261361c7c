"""The plant's state."""

from dataclasses import dataclass

import numpy as np


@dataclass
class State:
    """All that the kernel remembers from step to step. Angles and speeds are the joint's: motor's / ratio."""

    random: np.uint64  # the plant's own stream, see randomness.py
    sensor_seed: np.uint64  # of the measurement noise, which takes nothing from that stream
    steps: np.int64  # taken since the plant was made
    origin_steps: np.int64  # taken when the present step length came into force
    origin_s: float = 0.0  # the time then
    rotor_rad: float = 0.0
    rotor_rad_s: float = 0.0
    arm_rad: float = 0.0
    arm_rad_s: float = 0.0
    rotor_mean_rad_s: float = 0.0  # mean over the last step
    arm_mean_rad_s: float = 0.0
    current_a: float = 0.0
    supply_v: float = 0.0  # at the end of the last step
    contact_n_m: float = 0.0  # torque of the teeth on the arm, mean over the last step
    clutch_rad: float = 0.0  # angle that the clutch has slipped
    leant_n_m: float = 0.0  # torque of wall and end stops on the arm, mean over the last step
    hand_n_m: float = 0.0  # torque of the operator's hand on the arm, mean over the last step
    bristle_rad: float = 0.0  # deflection of the drive side's bristles, at the motor shaft
    arm_bristle_rad: float = 0.0
    slid: bool = False  # the drive side's bristles have slipped since the motion last turned
    hose_first_rad: float = 0.0  # bend of the hose's strands
    hose_second_rad: float = 0.0
    hose_third_rad: float = 0.0
    jumped: bool = False  # dry friction has jumped to its other value
    ripple_turns: float = 0.0  # phase of the supply's ripple
    rest_s: float = 0.0  # age of the drive side's contact
    arm_rest_s: float = 0.0
    static_factor: float = 1.0  # this stop's static friction over the nominal one
    coulomb_factor: float = 1.0  # Coulomb friction here over the nominal one
    travelled_rad: float = 0.0  # way of the motor since the plant was made
    wandered_rad: float = 0.0  # way since that was last drawn
    winding_c: float = 25.0
    housing_c: float = 25.0
    # energy since the plant was made
    supplied_j: float = 0.0
    electrical_loss_j: float = 0.0
    friction_loss_j: float = 0.0
    arm_friction_loss_j: float = 0.0
    contact_loss_j: float = 0.0
    leant_loss_j: float = 0.0


def at_rest(seed: int, temperature_c: float) -> State:
    """Return the state at rest at angle 0."""
    random, sensor_seed = np.random.SeedSequence(seed).generate_state(2, np.uint64)
    return State(random, sensor_seed, np.int64(0), np.int64(0), winding_c=temperature_c, housing_c=temperature_c)
