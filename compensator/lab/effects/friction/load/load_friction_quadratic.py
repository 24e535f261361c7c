"""Quadratic load-dependent friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape, at_rest
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Square of the transmitted load against the motion."""
    return (motion.load_effort**2 * motion.direction)[None]


def discrepancy(motion: Motion, _: Shape) -> FloatArray:
    """What else the teeth transmit, friction and inertia beyond them: derivatives of (load + D v + J a)^2."""
    return np.array([np.abs(motion.velocity), motion.acceleration * motion.direction]) * motion.load_effort


PARAMETERS = (Parameter("quadratic load loss", "1/{effort}", 0.0),)

EFFECT = Effect(
    name="load_friction_quadratic",
    title="Quadratic load-dependent friction",
    physics=(
        "Gear friction that grows faster than the transmitted torque: teeth and bearings deflect and more surface rubs."
    ),
    equation=r"\mu_2\,\hat\tau_{load}^2\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=PARAMETERS,
    driver="load",
    excited_by="at least three loads spread over a factor of six",
    source="Rhoban/bam, model M6",
    confused_with=("load_friction",),
    builds_on="load",
    breakaway=at_rest(columns, PARAMETERS, "load"),
    dry_friction=True,
    discrepancy=discrepancy,
)
