"""The arm behind the free play of its gear, which no sensor sees, and the torque that the teeth carry.

    J dw/dt = T - L - s f      T > 0 on the flank where the motor pushes the arm, T < 0 on the other, T = 0 between them

L is the load, f the friction of the arm's own bearings, s its direction. The encoder is on the motor's side: it shows
the arm to within the free play. What is known of the load shows on which flank it lies, and how it falls from one to
the other. Teeth that meet stay together: how far they bounce nobody knows, and the momentum is passed on either way.

One step of time is one control cycle (Moreau's time stepping: first the free motion, then what the flanks allow).
Torques are motor currents [A]; angles and speeds are the joint's.
"""

from math import copysign

from compensator.motion.joint_model import JointUnderLoad
from compensator.motion.load_estimate import ArmState


def begin(motor_rad: float, gravity_a: float, free_play_rad: float) -> ArmState:
    """An arm at rest: its weight lies on one flank, in the middle of the free play where it has no moment."""
    side = copysign(1.0, gravity_a) if gravity_a != 0.0 else 0.0
    return ArmState(motor_rad - side * free_play_rad / 2.0, 0.0, motor_rad, 0.0, gravity_a, side)


def follow(
    joint: JointUnderLoad, arm: ArmState, motor_rad: float, more_a: float, free_play_rad: float, period_s: float
) -> ArmState:
    """One control cycle.

    Args:
        joint: the model under the present load.
        arm: the cycle before.
        motor_rad: angle of the motor's side, as measured now.
        more_a: load beyond the weight that the model knows [A].
        free_play_rad: of the gear, between the flanks.
        period_s: of the control loop.
    """
    half_rad, last_rad = free_play_rad / 2.0, arm.motor_rad
    motor_rad_s = (motor_rad - last_rad) / period_s
    load_a = joint.gravity_at(arm.angle_rad + 0.5 * arm.speed_rad_s * period_s) + more_a
    inertia = joint.arm_inertia_a_s2_rad
    if inertia == 0.0:
        side = copysign(1.0, load_a) if load_a != 0.0 else 0.0
        return ArmState(motor_rad - side * half_rad, motor_rad_s, motor_rad, motor_rad_s, load_a, side)
    # what the arm would do if the teeth did not touch: its own friction takes speed from it, and never turns it back
    pushed_rad_s = arm.speed_rad_s - load_a / inertia * period_s
    rubbed_rad_s = joint.arm_friction_a / inertia * period_s
    free_rad_s = copysign(max(abs(pushed_rad_s) - rubbed_rad_s, 0.0), pushed_rad_s)
    free_rad = arm.angle_rad + 0.5 * (arm.speed_rad_s + free_rad_s) * period_s
    # and what the flanks allow
    if abs(free_rad - motor_rad) < half_rad:
        return ArmState(free_rad, free_rad_s, motor_rad, motor_rad_s, 0.0, 0.0)
    side = copysign(1.0, motor_rad - free_rad)
    speed_rad_s = motor_rad_s
    if arm.side != side:
        # rotor and arm meet, and share their momentum
        rotor = joint.rotor_inertia_a_s2_rad
        speed_rad_s = (rotor * arm.motor_rad_s + inertia * free_rad_s) / (rotor + inertia)
    teeth_a = inertia * (speed_rad_s - free_rad_s) / period_s
    return ArmState(motor_rad - side * half_rad, speed_rad_s, motor_rad, motor_rad_s, teeth_a, side)
