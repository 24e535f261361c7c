"""Cogging of further orders."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

MOST_ORDERS = 6  # beside the first
HIGHEST_ORDER = 40  # per turn: poles times slots of small motors
HIGHEST_CYCLES = 30  # over the travel of a linear joint
_NUMBERS = ("second", "third", "fourth", "fifth", "sixth", "seventh")


def shapes(motion: Motion) -> list[Shape]:
    """One further order each; `shape_search` goes on from the best as long as the rows pay for another."""
    if motion.facts.joint == "rotary":
        orders = [float(order) for order in range(1, HIGHEST_ORDER + 1)]
    else:
        orders = [2.0 * np.pi * cycles / motion.position_span for cycles in range(1, HIGHEST_CYCLES + 1)]
    return [(order, *[0.0] * (MOST_ORDERS - 1)) for order in orders]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Cosine and sine of every order, averaged over a sample; none where an order is 0."""
    rows: list[FloatArray] = []
    nothing = np.zeros(len(motion.position))
    for order in shape:
        phase, size = order * motion.position, motion.averaged(order)
        rows += [np.cos(phase) * size, np.sin(phase) * size] if order > 0.0 else [nothing, nothing]
    return np.array(rows)


EFFECT = Effect(
    name="cogging_orders",
    title="Cogging of further orders",
    physics=(
        "Poles, slots, and what is uneven about them make a torque of several orders that goes round with the shaft: "
        "the least common multiple of poles and slots, its multiples, and the orders of a rotor off its centre."
    ),
    equation=r"\sum_i a_i \cos k_i q + b_i \sin k_i q",
    columns=columns,
    parameters=tuple(
        Parameter(f"{part} part of the {number} order", "{effort}")
        for number in _NUMBERS
        for part in ("cosine", "sine")
    ),
    driver="position",
    excited_by="slow motion over whole turns, in both directions, more than once",
    source="Zhu, Howe 2000",
    shapes=shapes,
    shape_names=tuple(f"{number} order" for number in _NUMBERS),
    confused_with=("position_periodic_friction",),
    after=("cogging",),
    grows=True,
)
