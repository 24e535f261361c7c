"""Dead time of the power stage, and the voltage that brushes take."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import BY_VOLTAGE
from compensator.lab.recordings.recording import FloatArray


def shapes(_: Motion) -> list[Shape]:
    """Shares of the largest effort below which the predicted effort is too uncertain to tell its sign."""
    return [(0.0025,), (0.005,), (0.01,), (0.02,), (0.05,)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Sign of the predicted current, smooth where it passes through zero, for shape (share,)."""
    return np.tanh(_over_uncertain(motion, shape))[None]


def discrepancy(motion: Motion, shape: Shape) -> FloatArray:
    """Where the current is zero, as it is not known as well as effort: derivatives of tanh(i + i_0 + F sgn v + D v)."""
    near_zero = 1.0 - np.tanh(_over_uncertain(motion, shape)) ** 2
    return np.array([near_zero, near_zero * motion.direction, near_zero * motion.velocity])


def slope(motion: Motion, shape: Shape) -> FloatArray:
    """Derivative of the smooth sign by the predicted effort."""
    width = shape[0] * (motion.largest_effort or 1.0)
    return (1.0 - np.tanh(_over_uncertain(motion, shape)) ** 2)[None] / width


def _over_uncertain(motion: Motion, shape: Shape) -> FloatArray:
    """Predicted effort over that below which its sign is not sure."""
    found: FloatArray = motion.driven / (shape[0] * (motion.largest_effort or 1.0))
    return found


EFFECT = Effect(
    name="dead_time",
    title="Dead time or brush drop",
    physics=(
        "For a moment of each PWM period both switches of a leg are off, and brushes, where there are any, take a volt "
        "or so: a voltage is lost against the current, whatever its size. A voltage that is measured at the motor's "
        "terminals holds that of the brushes alone."
    ),
    equation=r"u_d\,\mathrm{sgn}(\hat i)",
    columns=columns,
    parameters=(Parameter("voltage lost, as effort", "{effort}", 0.0),),
    driver="effort",
    excited_by="holds and slow motion at small torque of both signs",
    source="dead time: Jeong, Park 1991; brushes: Fitzgerald, Kingsley, Umans 2003",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("share of the largest effort at which its sign is sure",),
    confused_with=("coulomb", "torque_constant_saturation"),
    efforts=BY_VOLTAGE,
    builds_on="effort",
    discrepancy=discrepancy,
    slope=slope,
)
