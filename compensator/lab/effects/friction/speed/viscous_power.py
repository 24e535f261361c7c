"""Viscous friction by a power law."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

EXPONENTS = (0.15, 0.3, 0.45, 0.6, 0.75)


def shapes(_: Motion) -> list[Shape]:
    """Exponents below 1: friction grows ever more slowly."""
    return [(exponent,) for exponent in EXPONENTS]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Power of the speed against the motion; 1 at the fast speed of all trials."""
    speed = np.abs(motion.velocity) / motion.fast
    return (speed ** shape[0] * motion.direction)[None]


EFFECT = Effect(
    name="viscous_power",
    title="Viscous friction by a power law",
    physics=(
        "Grease thins as it is sheared, and warms where it is: its friction grows by less and less with speed, as a "
        "power of it below 1."
    ),
    equation=r"F_p\,|\dot q/\dot q_{fast}|^{n}\,\mathrm{sgn}(\dot q),\ n < 1",
    columns=columns,
    parameters=(Parameter("friction at the fast speed", "{effort}", 0.0),),
    driver="velocity",
    excited_by="speeds over a range of ten and more, each held",
    source="Waiboer, Aarts, Jonker 2005",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("exponent",),
    confused_with=("stribeck", "viscous_quadratic"),
)
