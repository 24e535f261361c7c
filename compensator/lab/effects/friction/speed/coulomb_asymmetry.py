"""Direction-asymmetric Coulomb friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """1 while moving."""
    return np.abs(motion.direction)[None]


PARAMETERS = (Parameter("half difference of Coulomb friction", "{effort}"),)

EFFECT = Effect(
    name="coulomb_asymmetry",
    title="Direction-asymmetric Coulomb friction",
    physics=(
        "Coulomb friction that differs by direction. While the joint moves, it is the same as an offset of "
        "the effort; only a reading at rest tells them apart."
    ),
    equation=r"\Delta F_c\,|\mathrm{sgn}(\dot q)|",
    columns=columns,
    parameters=PARAMETERS,
    driver="direction",
    excited_by="breakaway on both sides at rest, or the current of a joint at rest with nothing to hold",
    source="Saini et al. 2013, section 2.4 (assumed away there)",
    confused_with=("offset",),
    hidden_by=("offset",),
    breakaway=at_rest(columns, PARAMETERS, "direction"),
    dry_friction=True,
)
