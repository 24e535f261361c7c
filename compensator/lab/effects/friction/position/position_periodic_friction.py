"""Position-periodic friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

MOTOR_ORDERS = (1, 2)  # an eccentric pinion; the wave generator of a harmonic drive


def shapes(motion: Motion) -> list[Shape]:
    """Orders per joint turn, and per motor turn where the gear ratio is known; cycles over a linear joint's travel."""
    if motion.facts.joint != "rotary":
        return [(2.0 * np.pi * cycles / motion.position_span,) for cycles in range(1, 31)]
    joint: list[Shape] = [(float(order),) for order in range(3, 31)]
    ratio = motion.facts.gear_ratio
    return joint if ratio is None else joint + [(order * ratio,) for order in MOTOR_ORDERS if order * ratio > 30.0]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Cosine and sine of the k-th order against the motion, averaged over a sample."""
    phase = shape[0] * motion.position
    return np.array([np.cos(phase), np.sin(phase)]) * motion.averaged(shape[0]) * motion.direction


EFFECT = Effect(
    name="position_periodic_friction",
    title="Position-periodic friction",
    physics=("Friction that rises and falls round the turn: a bent shaft, an eccentric gear, a damaged tooth."),
    equation=r"(a \cos kq + b \sin kq)\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(
        Parameter("cosine part", "{effort}"),
        Parameter("sine part", "{effort}"),
    ),
    driver="position",
    excited_by="slow motion over the whole range, in both directions",
    source="Garcia et al. 2002; common in harmonic drives",
    shapes=shapes,
    shape_names=("order",),
    confused_with=("load_friction",),
    dry_friction=True,
)
