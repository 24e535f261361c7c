"""Encoder that reads off its centre."""

import numpy as np

from compensator.lab.differentiation import rate_of_change
from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recording import FloatArray


def shapes(motion: Motion) -> list[Shape]:
    """Once and twice a turn of the motor, which carries the encoder."""
    ratio = motion.facts.gear_ratio or 1.0
    return [(ratio,), (2.0 * ratio,)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """Second rates of change of the cosine and sine of the encoder's turn, for shape (n,)."""
    rate = 1.0 / (motion.time_s[1] - motion.time_s[0])
    phase = shape[0] * motion.position
    return np.array([rate_of_change(rate_of_change(part, rate), rate) for part in (np.cos(phase), np.sin(phase))])


EFFECT = Effect(
    name="encoder_eccentricity",
    title="Encoder eccentricity",
    physics=(
        "A disc or magnet off its centre reads an angle that swings once a turn: the model sees accelerations "
        "that never were."
    ),
    equation=r"J\,\frac{d^2}{dt^2}(a\cos nq + b\sin nq)",
    columns=columns,
    parameters=(
        Parameter("cosine part", "{effort} s2"),
        Parameter("sine part", "{effort} s2"),
    ),
    driver="position",
    excited_by="steady speeds at which a turn of the encoder lies within the pass band",
    source="common in magnetic encoders",
    shapes=shapes,
    shape_names=("encoder turns per joint turn",),
    confused_with=("cogging",),
    facts=("gear_ratio",),
    pipeline=True,
)
