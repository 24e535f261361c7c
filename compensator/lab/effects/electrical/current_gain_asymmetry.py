"""A current sensor with two gains."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

# One of two shunts in parallel has come off: one gain is twice the other. More is no gain of a sensor.
LARGEST = 1.0 / 3.0


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Size of the predicted effort."""
    return np.abs(motion.predicted)[None]


EFFECT = Effect(
    name="current_gain_asymmetry",
    title="Current gain by sign",
    physics=("A current sensor whose gain differs between positive and negative current, as with two shunts."),
    equation=r"\gamma\,|\hat\tau|",
    columns=columns,
    parameters=(Parameter("half the difference of the gains", "1", -LARGEST, LARGEST),),
    driver="effort",
    excited_by="the same load lifted to both sides",
    source="data sheets of low-side shunts",
    confused_with=("viscous_asymmetry", "coulomb_asymmetry", "offset"),
    builds_on="effort",
)
