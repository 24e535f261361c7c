"""Friction that falls with time in motion."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray


def shapes(motion: Motion) -> list[Shape]:
    """Times from a fifth of a session to twice a session."""
    return [(float(share * motion.session_span_s),) for share in (0.2, 0.5, 1.0, 2.0)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What is left of the cold excess against the motion, for shape (t_w,)."""
    return (np.exp(-motion.session_s / shape[0]) * motion.direction)[None]


def discrepancy(motion: Motion, shape: Shape) -> FloatArray:
    """What surfaces lose as they run in goes with the way and not with time, and none is known to be what counts."""
    way = motion.session_way_s / shape[0]
    return np.array([np.exp(-way), way * np.exp(-way)]) * motion.direction


EFFECT = Effect(
    name="warm_up",
    title="Warm-up",
    physics=(
        "Friction falls from its cold value over the first minutes, as lubricant spreads and surfaces run in, "
        "whatever the thermometer says."
    ),
    equation=r"c\,e^{-t/t_w}\,\mathrm{sgn}(\dot q)",
    columns=columns,
    parameters=(Parameter("cold excess", "{effort}", 0.0),),
    driver="session_time",
    excited_by="the same slow trial at the start, in the middle and at the end of a session",
    source="Bittencourt et al. 2010",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("warm-up time",),
    shape_units=("s",),
    confused_with=("coulomb_temperature", "motor_warm_up"),
    varies_with="session_s",
    dry_friction=True,
    discrepancy=discrepancy,
)
