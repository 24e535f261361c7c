"""Direction-asymmetric viscous friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Speed, whatever the direction."""
    return np.abs(motion.velocity)[None]


EFFECT = Effect(
    name="viscous_asymmetry",
    title="Direction-asymmetric viscous friction",
    physics=(
        "Viscous friction that differs by direction of motion: preloaded guides or seals, a screw's flanks, a "
        "grease that is wiped one way."
    ),
    equation=r"\Delta F_v\,|\dot q|",
    columns=columns,
    parameters=(Parameter("half difference of viscous friction", "{effort} s/{position}"),),
    driver="velocity",
    excited_by="several speeds in both directions",
    source="Janot, Gautier, Brunot 2019 (EMPS)",
    confused_with=("offset", "centre_of_mass_angle", "coulomb_asymmetry"),
)
