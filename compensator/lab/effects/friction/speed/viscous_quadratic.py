"""Quadratic viscous friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Velocity times speed."""
    return (motion.velocity * np.abs(motion.velocity))[None]


EFFECT = Effect(
    name="viscous_quadratic",
    title="Quadratic viscous friction",
    physics=(
        "Drag that grows with the square of speed: churning of grease, air drag, turbulence. It stands for other "
        "powers above 1, too."
    ),
    equation=r"F_{q}\,\dot q |\dot q|",
    columns=columns,
    parameters=(Parameter("quadratic friction", "{effort} s2/{position}2", 0.0),),  # else it stands for a power law
    driver="velocity",
    excited_by="the fastest speeds that the joint reaches",
    source="Rhoban/bam, model M6",
    confused_with=("viscous", "stribeck", "viscous_power"),
)
