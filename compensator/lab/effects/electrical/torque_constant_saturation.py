"""Torque constant that falls with current."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Square of the predicted effort by current, with its sign."""
    return (motion.driven * np.abs(motion.driven))[None]


EFFECT = Effect(
    name="torque_constant_saturation",
    title="Saturating torque constant",
    physics=(
        "At high current the iron saturates and each further ampere gives less torque: the current rises "
        "faster than the torque."
    ),
    equation=r"\kappa\,\hat\tau\,|\hat\tau|",
    columns=columns,
    parameters=(Parameter("excess current per effort squared", "1/{effort}", 0.0),),
    driver="effort",
    excited_by="holds and lifts with small and with very large torque",
    source="Rhoban/bam; common in iron-core motors",
    confused_with=("load_friction_quadratic", "gravity"),
    builds_on="effort",
)
