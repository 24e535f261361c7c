"""Offset."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """A constant."""
    return np.ones((1, len(motion.time_s)))


PARAMETERS = (Parameter("offset", "{effort}"),)

EFFECT = Effect(
    name="offset",
    title="Offset",
    physics=(
        "A constant bias of the effort: amplifier or current-sensor offset, a spring's constant part. While "
        "the joint moves, it cannot be told from Coulomb friction that differs by direction."
    ),
    equation=r"\tau_0",
    columns=columns,
    parameters=PARAMETERS,
    driver="direction",
    excited_by="motion in both directions, and a reading at rest with the power stage off",
    source="Janot, Gautier, Brunot 2019 (EMPS)",
    confused_with=("coulomb_asymmetry",),
    breakaway=at_rest(columns, PARAMETERS, "direction"),
)
