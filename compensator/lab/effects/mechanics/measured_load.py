"""Load that a torque sensor measures."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def columns(motion: Motion, _: Shape) -> FloatArray:
    """The measured load, weight and inertia of what hangs beyond the sensor included."""
    return (motion.measured_load * np.ones(len(motion.time_s)))[None]


EFFECT = Effect(
    name="measured_load",
    title="Measured load",
    physics=(
        "What a torque sensor between gear and load reads: all that the joint drives or holds, whatever it is. Effects "
        "of the load are judged on it instead of on a predicted weight."
    ),
    equation=r"c\,\tau_{sensor}",
    columns=columns,
    parameters=(Parameter("effort per N m of load", "{effort}/(N m)", 0.0),),
    driver="load",
    excited_by="loads that vary independently of the motion, of both signs",
    source="Newton",
    channels=("load_torque_n_m",),
    confused_with=("gravity", "inertia"),
    carried=True,
)
