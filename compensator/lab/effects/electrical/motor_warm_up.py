"""Effort that grows as the motor warms over a session, without a thermometer."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.facts import BY_VOLTAGE
from compensator.lab.recordings.recording import FloatArray

# 100 K warmer, copper resists 39 % more and ferrite pulls 20 % less: 1.39 / 0.8 of the voltage, 1 / 0.8 of the current
LARGEST_RISE = 0.75


def shapes(motion: Motion) -> list[Shape]:
    """Times from a fifth of a session to twice a session."""
    return [(float(share * motion.session_span_s),) for share in (0.2, 0.5, 1.0, 2.0)]


def warmth(motion: Motion, shape: Shape) -> FloatArray:
    """Share of the final warmth that is reached, for shape (t_m,); (n,)."""
    return np.asarray(1.0 - np.exp(-motion.session_s / shape[0]))


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Predicted effort by current times the warmth that is reached, for shape (t_m,)."""
    return (warmth(motion, shape) * motion.driven)[None]


def discrepancy(motion: Motion, shape: Shape) -> FloatArray:
    """What magnets that pull less leave where the effort comes from a voltage: the back-EMF falls with them."""
    if motion.facts.effort not in BY_VOLTAGE:
        return np.empty((0, len(motion.velocity)))
    return (warmth(motion, shape) * motion.velocity)[None]


EFFECT = Effect(
    name="motor_warm_up",
    title="Warm-up of the motor",
    physics=(
        "The motor warms from the start of a session on, and nobody measures its temperature: copper resists more, and "
        "magnets pull less. The same torque takes more voltage, or more current, be it for inertia, weight or friction."
    ),
    equation=r"\alpha\,(1 - e^{-t/t_m})\,\hat\tau",
    columns=columns,
    parameters=(Parameter("relative rise", "1", 0.0, LARGEST_RISE),),
    driver="session_time",
    excited_by="the same lifts at the start, in the middle and at the end of a session",
    source="copper: 0.0039 / K; ferrite: 0.002 / K; a body that warms with one time constant",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("warm-up time",),
    shape_units=("s",),
    confused_with=("winding_temperature", "warm_up"),
    builds_on="effort",
    varies_with="session_s",
    discrepancy=discrepancy,
)
