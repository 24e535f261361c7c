"""Inertia."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Acceleration as it is read, and that times the load's inertia; what is misread of it has an effect of its own."""
    read = motion.acceleration + motion.misread_acceleration
    return np.array([read, motion.load_inertia_kg_m2 * read])


EFFECT = Effect(
    name="inertia",
    title="Inertia",
    physics=(
        "Effort that accelerates the rotor (through the gear, ratio squared), the arm, and the load at its "
        "tip as a point mass."
    ),
    equation=r"J\,\ddot q + s\,m l^2 \ddot q",
    columns=columns,
    parameters=(
        Parameter("inertia", "{effort} s2/{position}", 0.0),
        Parameter("load inertia scale", "{effort} s2/({position} {inertia})", 0.0),
    ),
    driver="acceleration",
    excited_by="accelerations that differ at the same speed and position: sines of several frequencies, steps",
    source="Newton",
    confused_with=("measurement_delay",),
)
