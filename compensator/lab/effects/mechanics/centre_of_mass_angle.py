"""Centre-of-mass angle."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """cos q for the arm, and times the load's moment."""
    cosine = np.cos(motion.position)
    return np.array([cosine, motion.load_moment_n_m * cosine])


PARAMETERS = (
    Parameter("arm moment at angle 0", "{effort}"),
    Parameter("load moment share at angle 0", "{effort}/(N m)"),
)

EFFECT = Effect(
    name="centre_of_mass_angle",
    title="Centre-of-mass angle",
    physics=("The centre of mass does not lie on the line that the encoder calls zero: gravity turns by an angle."),
    equation=r"(m_a g l_a + s\,m g l)\,\alpha \cos q",
    columns=columns,
    parameters=PARAMETERS,
    driver="position",
    excited_by="slow motion on both sides of 0, beyond 45 degrees",
    source="statics",
    confused_with=("offset", "viscous_asymmetry"),
    carried=True,
    by_angle=True,
    breakaway=at_rest(columns, PARAMETERS, "position"),
)
