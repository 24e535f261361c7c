"""Effort that grows with the motor's temperature."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import BY_VOLTAGE
from compensator.lab.recordings.recording import FloatArray

REFERENCE_C = 25.0  # where the plain coefficients hold


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Predicted effort by current times temperature above the reference."""
    return ((motion.temperature_c - REFERENCE_C) * motion.driven)[None]


def discrepancy(motion: Motion, _: Shape) -> FloatArray:
    """What magnets that pull less leave where the effort comes from a voltage: the back-EMF falls with them."""
    if motion.facts.effort not in BY_VOLTAGE:
        return np.empty((0, len(motion.velocity)))
    return ((motion.temperature_c - REFERENCE_C) * motion.velocity)[None]


EFFECT = Effect(
    name="winding_temperature",
    title="Winding resistance with temperature",
    physics=(
        "Copper resists more as it warms, and magnets pull less: the same torque takes more voltage, or more "
        "current, in proportion."
    ),
    equation=r"\alpha\,(T - T_0)\,\hat\tau",
    columns=columns,
    parameters=(Parameter("relative rise per kelvin", "1/K", -0.02, 0.02),),
    driver="temperature",
    excited_by="the same lifts cold and warm",
    source="copper: 0.0039 / K; ferrite: 0.002 / K",
    channels=("temperature_c",),
    confused_with=("coulomb_temperature", "viscous_temperature", "motor_warm_up"),
    builds_on="effort",
    varies_with="temperature_c",
    discrepancy=discrepancy,
)
