"""The load of a joint in motion, from a window of readings.

    I = J_rotor dw/dt + s F(w) + T + loss(T) - d s f,     T = L + J_arm dw_arm/dt + s f

averaged over the window (`local_motion`). F is the friction of the balanced joint; it holds f, the friction of the
arm's bearings, and what the teeth lose of it, d f. L is a load that the model knows, and what is left of I is load
beyond that. The motor is measured; the arm is where the free play lets it be (`free_play`).
"""

from collections.abc import Sequence
from itertools import groupby
from math import hypot, sqrt
from operator import attrgetter

import numpy as np

from compensator.motion.gear_loss import GearLoss
from compensator.motion.joint_model import FloatArray, JointUnderLoad, MotionFriction
from compensator.motion.load_estimate import (
    ArmState,
    Branch,
    EstimatorSettings,
    EstimatorState,
    LoadEstimate,
    Observation,
)
from compensator.motion.local_motion import Window, window

BAND = 1.96  # standard deviations in half of a 95 % interval
TOUCHING = 8  # cycles over which what the teeth carry is averaged
TINY_RAD_S = 1e-9  # stands for the direction of a joint that has only just set off


def moving_load(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> LoadEstimate:
    """What the window's mean current is more than the modelled load explains, and that load now."""
    averages = window(settings.window, settings.period_s)
    if joint.studied is None:
        more_a, friction_a = _by_curves(joint, averages, state)
    else:
        more_a, friction_a = _by_study(joint, joint.studied, averages, settings, state, observation)
    inertia = joint.rotor_inertia_a_s2_rad + joint.arm_inertia_a_s2_rad
    noise_a = inertia * averages.acceleration_noise_rad_s2(settings.count_rad)
    spread_a = hypot(joint.friction_scatter * friction_a, noise_a, sqrt(state.variance_a2))
    now_a = joint.gravity_at(observation.position_rad)
    return LoadEstimate(more_a + now_a, BAND * spread_a, Branch.MOVING, friction_a)


def _by_curves(joint: JointUnderLoad, averages: Window, state: EstimatorState) -> tuple[float, float]:
    """Load beyond the weight [A], and friction [A]: by the curves and what the gear loses."""
    motion, way, loss = averages.motion(state.positions_rad), state.direction, joint.gear_loss
    friction_a = joint.friction_a(motion.speed_rad_s, way)
    rotor_a = joint.rotor_inertia_a_s2_rad * motion.acceleration_rad_s2
    taken_a = averages.mean_held(state.mores_a)
    carried_a = _carried_a(joint, averages, state) + taken_a
    lost_a = averages.mean_held([_lost_a(loss, arm, way) for arm in state.arms])
    lost_a -= way * loss.driving * joint.arm_friction_a
    left_a = averages.mean_held(state.currents_a) - rotor_a - friction_a - carried_a - lost_a
    # a load more is a current more by what the teeth lose of it
    found_a = loss.load_current_a(loss.motor_current_a(carried_a, way) + left_a, way)
    return taken_a + found_a - carried_a, friction_a


def _carried_a(joint: JointUnderLoad, averages: Window, state: EstimatorState) -> float:
    """Mean of what the teeth carry of the weight and of what accelerates the arm [A]."""
    angles_rad = [arm.angle_rad for arm in state.arms]
    weight_a = averages.mean([joint.gravity_at(angle_rad) for angle_rad in angles_rad])
    return weight_a + joint.arm_inertia_a_s2_rad * averages.motion(angles_rad).acceleration_rad_s2


def _lost_a(loss: GearLoss, arm: ArmState, way: float) -> float:
    """What the teeth lose of what they pass on [A]; by the flank, since noise may turn the sign of a small torque."""
    if arm.side == 0.0:
        return 0.0
    return arm.teeth_a * (loss.driving if arm.side * way > 0.0 else -loss.back_driving)


def _by_study(
    joint: JointUnderLoad,
    studied: MotionFriction,
    averages: Window,
    settings: EstimatorSettings,
    state: EstimatorState,
    observation: Observation,
) -> tuple[float, float]:
    """The same with what a study found: friction wherever the window has been; the gear's loss is in it."""
    motion, way = averages.motion(state.positions_rad), state.direction
    positions = np.array(state.positions_rad)
    ages_s = settings.period_s * (np.arange(len(positions)) - (len(positions) - 1) / 2.0)
    speeds = way * np.maximum(way * (motion.speed_rad_s + motion.acceleration_rad_s2 * ages_s), 0.0)
    friction = studied.current_a(
        positions, np.where(speeds == 0.0, way * TINY_RAD_S, speeds), motion.acceleration_rad_s2,
        _teeth_a(state.arms), joint.gravity_a, observation.temperature_c,
    )  # fmt: skip
    friction_a = averages.mean(friction.tolist())
    rotor_a = joint.rotor_inertia_a_s2_rad * motion.acceleration_rad_s2
    carried_a = _carried_a(joint, averages, state)
    return averages.mean_held(state.currents_a) - rotor_a - friction_a - carried_a, friction_a


def _teeth_a(arms: Sequence[ArmState]) -> FloatArray:
    """What the teeth passed on in each cycle [A], shape (n,), averaged over some cycles that they touch on one flank.

    The counts of the encoder make a single one noisy, and friction goes by its size: the noise would not average out.
    """
    found = []
    for _, touch in groupby(arms, attrgetter("side")):
        torques_a = np.array([arm.teeth_a for arm in touch])
        parts = np.array_split(torques_a, max(1, len(torques_a) // TOUCHING))
        found += [np.full(len(part), part.mean()) for part in parts]
    return np.concatenate(found)
