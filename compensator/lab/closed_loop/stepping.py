"""The motion of one trial under its control law: steps in time, friction set-valued and implicit.

A linear law C takes the measured joint to u = C(r - q) and the model's to u' = C(r - q'): the difference is
C(q - q'), whatever the set point r was. So the recorded effort, and what the law makes of how far the model's joint
is from the measured one, is what drives it; no feed-forward, shaping or offset of the servo has to be known. Where a
law has a dead-band, the set point is needed, and u' - u = C(r - q') - C(r - q).
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from compensator.lab.recordings.recording import BoolArray, FloatArray

LONGEST_STEP_S = 1e-3
FARTHEST = 1e6  # rad or m: a joint that runs away stops there, before its numbers end


class Drive(NamedTuple):
    """What a trial was driven by, on its grid; arrays of shape (n,).

    Attributes:
        step_s: of the grid.
        closed: the loop is closed; elsewhere the joint is where it was measured.
        target: set point; the measured position where there is none.
        position, velocity: measured.
        effort: measured.
        stiffness, integral, damping, dead_band: of the control law.
    """

    step_s: float
    closed: BoolArray
    target: FloatArray
    position: FloatArray
    velocity: FloatArray
    effort: FloatArray
    stiffness: float
    integral: float
    damping: float
    dead_band: float


class Resistance(NamedTuple):
    """What the model takes of the effort near a motion, linearised; arrays of shape (n,).

    Attributes:
        inertia: effort per acceleration.
        position, velocity: of the motion.
        middle: effort without inertia, between the two directions; per_position, per_velocity: its derivatives.
        dry: half of what the directions differ by, at least 0.
    """

    inertia: float
    position: FloatArray
    velocity: FloatArray
    middle: FloatArray
    per_position: FloatArray
    per_velocity: FloatArray
    dry: FloatArray


def moved(drive: Drive, resistance: Resistance) -> tuple[FloatArray, FloatArray]:
    """Position of the model's joint, and the effort that the law adds to the measured one, shape (n,) each."""
    inner = max(1, int(np.ceil(drive.step_s / LONGEST_STEP_S)))
    position, added = _moved(inner, *drive, *resistance)
    return position, added


@njit(cache=True)
def _outside(error: float, dead_band: float) -> float:
    """A position error as a servo with a dead-band sees it."""
    return error if abs(error) > dead_band else 0.0


@njit(cache=True)
def _moved(
    inner: int, step_s: float, closed: BoolArray, target: FloatArray, measured: FloatArray, speed: FloatArray,
    effort: FloatArray, stiffness: float, integral: float, damping: float, dead_band: float,
    inertia: float, at: FloatArray, at_speed: FloatArray, middle: FloatArray, per_position: FloatArray,
    per_velocity: FloatArray, dry: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """As `moved`; implicit in the law, the resistance and friction, so that it is stable whatever the gains."""
    count = len(measured)
    position, added = np.empty(count), np.zeros(count)
    dt = step_s / inner
    q, v, summed = measured[0], speed[0], 0.0
    for i in range(count):
        if not closed[i]:
            q, v, summed = measured[i], speed[i], 0.0
        position[i] = q
        apart = _outside(target[i] - q, dead_band) - _outside(target[i] - measured[i], dead_band)
        added[i] = stiffness * apart + damping * (speed[i] - v) + integral * summed
        if i + 1 == count or not closed[i]:
            continue
        for step in range(inner):
            f = (step + 1.0) / inner
            g = 1.0 - f
            goal, goal_speed = g * measured[i] + f * measured[i + 1], g * speed[i] + f * speed[i + 1]
            wanted = g * target[i] + f * target[i + 1]
            taken = g * middle[i] + f * middle[i + 1]
            by_q = g * per_position[i] + f * per_position[i + 1]
            by_v = g * per_velocity[i] + f * per_velocity[i + 1]
            around, around_speed = g * at[i] + f * at[i + 1], g * at_speed[i] + f * at_speed[i + 1]
            holds = g * dry[i] + f * dry[i + 1]
            apart = _outside(wanted - q, dead_band) - _outside(wanted - goal, dead_band)
            summed += dt * apart
            acts = stiffness if abs(wanted - q) > dead_band else 0.0
            push = g * effort[i] + f * effort[i + 1] + stiffness * apart + damping * goal_speed + integral * summed
            push += inertia / dt * v - taken - by_q * (q - around) + by_v * around_speed
            resists = max(inertia / dt + damping + by_v + dt * (acts + by_q), 0.5 * inertia / dt)
            free = push / resists
            v = np.sign(free) * max(abs(free) - holds / resists, 0.0)
            q += dt * v
            if abs(q) > FARTHEST:
                q, v = FARTHEST * np.sign(q), 0.0
    return position, added
