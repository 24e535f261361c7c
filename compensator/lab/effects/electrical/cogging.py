"""Cogging and gear-mesh ripple."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

MOTOR_ORDERS = (1, 2, 4, 6, 8, 10, 12, 14, 18, 20, 24, 28, 30, 36)  # poles, slots, and their common multiples


def shapes(motion: Motion) -> list[Shape]:
    """Orders per joint turn, and per motor turn where the gear ratio is known; cycles over a linear joint's travel."""
    if motion.facts.joint != "rotary":
        return [(2.0 * np.pi * cycles / motion.position_span,) for cycles in range(2, 31)]
    joint: list[Shape] = [(float(order),) for order in range(3, 31)]
    ratio = motion.facts.gear_ratio
    return joint if ratio is None else joint + [(order * ratio,) for order in MOTOR_ORDERS if order * ratio > 30.0]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Cosine and sine of the k-th order of the joint, averaged over a sample."""
    phase = shape[0] * motion.position
    return np.array([np.cos(phase), np.sin(phase)]) * motion.averaged(shape[0])


EFFECT = Effect(
    name="cogging",
    title="Cogging",
    physics=(
        "The magnets pull the rotor towards the slots of the iron, and wheels mesh unevenly: a torque that "
        "goes round with the shaft, whatever the direction of motion."
    ),
    equation=r"a \cos kq + b \sin kq",
    columns=columns,
    parameters=(
        Parameter("cosine part", "{effort}"),
        Parameter("sine part", "{effort}"),
    ),
    driver="position",
    excited_by="slow motion over the whole range, in both directions",
    source="Jahns, Soong 1996",
    shapes=shapes,
    shape_names=("order",),
    confused_with=("position_periodic_friction", "spring"),
)
