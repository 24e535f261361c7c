"""What hangs beyond the gear, in steps of 0.1 ms: a body of its own, pushed by stiff teeth or by a soft shaft.

Nothing of the lab's closed forms is used: contact is a spring and a damper, friction a steep function of speed.
"""

from math import sin, tanh

import numpy as np
from numba import njit

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
    ahead, speeds = np.interp(fine_s, x.time_s, x.q), np.interp(fine_s, x.time_s, x.v)  # good to 1e-5 rad
    gear = (stiffness_n_m_rad, damping_n_m_s_rad, 0.5 * gap_rad)
    carried: Array = _carried(ahead, speeds, gear, inertia, moment, step_s)
    return carried[::STEPS] - inertia * x.a - moment * np.sin(x.q)


@njit(cache=True)
def _carried(
    ahead: Array, speeds: Array, gear: tuple[float, float, float], inertia: float, moment: float, step_s: float
) -> Array:
    """What a gear of a stiffness, a damping and half a gap carries, step by step."""
    stiffness, damping, half = gear
    q, v, carried = ahead[0], speeds[0], np.empty(len(ahead))
    for index in range(len(ahead)):
        twist = ahead[index] - q
        pressed = twist - half if twist > half else twist + half if twist < -half else 0.0
        torque = stiffness * pressed
        if pressed != 0.0 or half == 0.0:
            torque += damping * (speeds[index] - v)
        carried[index] = torque
        v += step_s * (torque - moment * sin(q) - FRICTION_N_M * tanh(v / 0.01)) / inertia
        q += step_s * v
    return carried


def loose_teeth(x: Truth) -> Array:
    """Teeth of 400 N m/rad that hardly bounce, with 30 mrad of free play."""
    return missing_torque(x, 400.0, 2.0, GAP_RAD)


def twisting(x: Truth) -> Array:
    """A shaft with which the bare arm swings at 50 rad/s."""
    return missing_torque(x, ARM_KG_M2 * 50.0**2, 0.04)
