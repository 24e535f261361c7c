"""Load-dependent friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Transmitted load against the motion."""
    return (np.abs(motion.load_effort) * motion.direction)[None]


PARAMETERS = (Parameter("share of the load lost", "1", 0.0, 1.0),)

EFFECT = Effect(
    name="load_friction",
    title="Load-dependent friction",
    physics=(
        "Gear friction in proportion to the torque that the teeth transmit. The load is predicted by the "
        "model, never taken from the measured effort."
    ),
    equation=r"\mu\,|\hat\tau_{load}|\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=PARAMETERS,
    driver="load",
    excited_by="several loads, moved slowly up and down",
    source="Rhoban/bam, model M3; Saini et al. 2013, section 3.2.2",
    confused_with=("load_friction_quadratic", "position_periodic_friction", "weight_friction"),
    builds_on="load",
    breakaway=at_rest(columns, PARAMETERS, "load"),
)
