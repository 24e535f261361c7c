"""Temperature-dependent viscous friction."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

REFERENCE_C = 25.0  # where the plain viscous coefficient holds


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Velocity times temperature above the reference."""
    return ((motion.temperature_c - REFERENCE_C) * motion.velocity)[None]


EFFECT = Effect(
    name="viscous_temperature",
    title="Temperature-dependent viscous friction",
    physics=("The lubricant thins as it warms: viscous friction falls with temperature."),
    equation=r"F_{vT}\,(T - T_0)\,\dot q",
    columns=columns,
    parameters=(Parameter("viscous friction per kelvin", "{effort} s/({position} K)", -np.inf, 0.0),),
    driver="temperature",
    excited_by="the same fast motion cold and warm, cold and warm interleaved",
    source="Bittencourt et al. 2010",
    channels=("temperature_c",),
    varies_with="temperature_c",
)
