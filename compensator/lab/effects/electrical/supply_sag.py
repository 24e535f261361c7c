"""A supply that sags, where the effort is computed with its nominal voltage."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import BY_VOLTAGE
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """Effort by current times the square of the duty, as predicted: over the largest."""
    return (motion.driven * _of_largest(motion) ** 2)[None]


def discrepancy(motion: Motion, _: Shape) -> FloatArray:
    """What else the duty holds where nobody tells the back-EMF: the other terms of D^2 i with D U = R i + k_e w."""
    if motion.back_emf:
        return np.empty((0, len(motion.predicted)))
    share = _of_largest(motion)
    return np.array([motion.velocity * share**2, motion.velocity**2 * share])


def _of_largest(motion: Motion) -> FloatArray:
    found: FloatArray = motion.predicted / (motion.largest_effort or 1.0)
    return found


EFFECT = Effect(
    name="supply_sag",
    title="Sagging supply",
    physics=(
        "The source has a resistance, and the stage draws the duty's share of the motor current from it: the more of "
        "both, the less voltage is there. Where the effort is computed with the nominal voltage, it is too large. "
        "A drive that measures its supply hides nothing."
    ),
    equation=r"s\,\hat\tau^3/\hat\tau_m^2",
    columns=columns,
    parameters=(Parameter("share of the supply lost at the largest effort", "1", 0.0, 1.0),),
    driver="effort",
    excited_by="holds and lifts with small and with very large torque; or a measured supply voltage",
    source="Kirchhoff; the stage as an ideal transformer of ratio D",
    confused_with=("torque_constant_saturation", "load_friction_quadratic"),
    efforts=BY_VOLTAGE,
    facts=("supply_is_nominal",),
    builds_on="effort",
    discrepancy=discrepancy,
)
