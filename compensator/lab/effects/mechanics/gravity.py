"""Gravity."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """sin q for the arm, and times the load's moment."""
    sine = np.sin(motion.position)
    return np.array([sine, motion.load_moment_n_m * sine])


PARAMETERS = (
    Parameter("arm moment", "{effort}"),
    Parameter("load moment scale", "{effort}/(N m)", 0.0),
)

EFFECT = Effect(
    name="gravity",
    title="Gravity",
    physics=(
        "Moment of the arm's own weight and of the load at its tip about the axis; angle 0 is vertically "
        "down. A balanced arm has none."
    ),
    equation=r"(m_a g l_a + s\,m g l) \sin q",
    columns=columns,
    parameters=PARAMETERS,
    driver="position",
    excited_by="angles on both sides of 0, slow motion, several loads",
    source="Saini et al. 2013, section 3.2.2; statics",
    confused_with=("spring", "centre_of_mass_angle"),
    carried=True,
    by_angle=True,
    breakaway=at_rest(columns, PARAMETERS, "position"),
)
