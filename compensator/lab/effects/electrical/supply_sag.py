"""A supply that sags, where the effort is computed with its nominal voltage."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import BY_VOLTAGE
from compensator.lab.recordings.recording import FloatArray


def shapes(_: Motion) -> list[Shape]:
    """From hardly any back-EMF beyond what the effort holds to one beside which the winding's drop is little."""
    return [(float(ratio),) for ratio in np.geomspace(0.1, 10.0, 5)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Effort by current times the square of the duty, as predicted: over the largest of both, for shape (ratio,)."""
    [ratio] = shape
    drop, back_emf = motion.predicted / (motion.largest_effort or 1.0), motion.velocity / (motion.fast or 1.0)
    return (motion.driven * ((drop + ratio * back_emf) / (1.0 + ratio)) ** 2)[None]


EFFECT = Effect(
    name="supply_sag",
    title="Sagging supply",
    physics=(
        "The source has a resistance, and the stage draws the duty's share of the motor current from it: the more of "
        "both, the less voltage is there. Where the effort is computed with the nominal voltage, it is too large. "
        "The duty holds the back-EMF, which a current that is computed from it does not. A drive that measures its "
        "supply hides nothing."
    ),
    equation=r"s\,\hat\tau\,(\hat\tau/\hat\tau_m + k\,\dot q/\dot q_m)^2/(1 + k)^2",
    columns=columns,
    parameters=(Parameter("share of the supply lost at the largest effort", "1", 0.0, 1.0),),
    driver="effort",
    excited_by="holds and lifts with small and with very large torque; or a measured supply voltage",
    source="Kirchhoff; the stage as an ideal transformer of ratio D",
    confused_with=("torque_constant_saturation", "load_friction_quadratic"),
    efforts=BY_VOLTAGE,
    facts=("supply_is_nominal",),
    builds_on="effort",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("back-EMF beyond the effort's at high speed, over the largest effort",),
)
