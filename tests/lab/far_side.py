"""What hangs beyond the gear, in steps of 0.1 ms: a body of its own, pushed by stiff teeth or by a soft shaft.

Nothing of the lab's closed forms is used: contact is a spring and a damper, friction a steep function of speed.
"""

from math import sin, tanh

import numpy as np

from tests.lab.synthetic import Array, Joint, Truth

STEPS = 50  # per sample
ARM_KG_M2 = 0.012  # of the whole 0.02 kg m2; the rest is the rotor
FRICTION_N_M = 0.003
GAP_RAD = 0.03


def missing_torque(x: Truth, stiffness_n_m_rad: float, damping_n_m_s_rad: float, gap_rad: float = 0.0) -> Array:
    """What the gear carries [N m], less what a rigid one would, shape (n,)."""
    step_s = float(x.time_s[1] - x.time_s[0]) / STEPS
    inertia, moment = ARM_KG_M2 + x.load_kg * x.arm_m**2, Joint().arm_moment + x.weight_n_m
    fine_s = np.linspace(x.time_s[0], x.time_s[-1], (len(x.time_s) - 1) * STEPS + 1)
    ahead = np.interp(fine_s, x.time_s, x.q).tolist()  # good to 1e-5 rad at these speeds
    speeds = np.interp(fine_s, x.time_s, x.v).tolist()
    q, v, half, carried = ahead[0], speeds[0], 0.5 * gap_rad, []
    for motor_q, motor_v in zip(ahead, speeds, strict=True):
        twist = motor_q - q
        pressed = twist - half if twist > half else twist + half if twist < -half else 0.0
        torque = stiffness_n_m_rad * pressed + (damping_n_m_s_rad * (motor_v - v) if pressed or not half else 0.0)
        carried.append(torque)
        v += step_s * (torque - moment * sin(q) - FRICTION_N_M * tanh(v / 0.01)) / inertia
        q += step_s * v
    return np.array(carried[::STEPS]) - inertia * x.a - moment * np.sin(x.q)


def loose_teeth(x: Truth) -> Array:
    """Teeth of 400 N m/rad that hardly bounce, with 30 mrad of free play."""
    return missing_torque(x, 400.0, 2.0, GAP_RAD)


def twisting(x: Truth) -> Array:
    """A shaft with which the bare arm swings at 50 rad/s."""
    return missing_torque(x, ARM_KG_M2 * 50.0**2, 0.04)
