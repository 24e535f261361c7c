"""Dead time of the power stage."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recording import FloatArray

SMOOTH_SHARE = 0.02  # of the largest effort: the sign of a small effort is uncertain


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Sign of the predicted effort, smooth where it passes through zero."""
    small = SMOOTH_SHARE * float(np.abs(motion.predicted).max() or 1.0)
    return np.tanh(motion.predicted / small)[None]


EFFECT = Effect(
    name="dead_time",
    title="Dead time of the power stage",
    physics=(
        "For a moment of each PWM period both switches of a leg are off: a voltage is lost against the "
        "current, whatever its size."
    ),
    equation=r"u_d\,\mathrm{sgn}(\hat i)",
    columns=columns,
    parameters=(Parameter("voltage lost, as effort", "{effort}", 0.0),),
    driver="effort",
    excited_by="holds and slow motion at small torque of both signs",
    source="Jeong, Park 1991",
    confused_with=("coulomb", "torque_constant_saturation"),
    efforts=("terminal_voltage", "current_estimate"),
    builds_on="effort",
)
