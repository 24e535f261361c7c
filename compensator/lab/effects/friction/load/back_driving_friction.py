"""Friction that differs between driving and back-driving."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Transmitted load against the motion, only where the load drives."""
    driven = motion.load_effort * motion.direction < 0.0
    return (np.abs(motion.load_effort) * motion.direction * driven)[None]


EFFECT = Effect(
    name="back_driving_friction",
    title="Friction while back-driven",
    physics=(
        "Teeth lose more, or less, where the load drives the motor than where the motor drives the load: "
        "sliding at the teeth changes the direction of the force between them."
    ),
    equation=r"\mu_b\,|\hat\tau_{load}|\,\mathrm{sgn}(\dot q)\;[\hat\tau_{load}\,\dot q < 0]",
    columns=columns,
    parameters=(Parameter("further share of the load lost while back-driven", "1", 0.0, 1.0),),
    driver="load",
    excited_by="several loads, raised and lowered slowly, with the weights and the torque constant known",
    source="Rhoban/bam, model M5; Wang, Kim 2015",
    confused_with=("gravity", "load_friction"),
    builds_on="load",
    hidden_by=("gravity",),
)
