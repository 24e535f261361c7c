"""Encoder that reads off its centre."""

import numpy as np

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.recording import FloatArray


def shapes(motion: Motion) -> list[Shape]:
    """Once and twice a turn of what carries the encoder: the motor, or the joint."""
    turns = motion.facts.sensor_turns or 1.0
    return [(turns,), (2.0 * turns,)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What accelerations and speeds that never were add to the effort, for shape (n,)."""
    speeds = _rates(motion, shape[0])
    rate = 1.0 / motion.step_s
    return np.array([*(motion.inertia * rate_of_change(speed, rate) for speed in speeds), *speeds])


def discrepancy(motion: Motion, shape: Shape) -> FloatArray:
    """A speed that is late, having been measured over a while; and all of it twice as often round: no disc is round."""
    late = [rate_of_change(speed, 1.0 / motion.step_s) for speed in _rates(motion, shape[0])]
    return np.array([*late, *columns(motion, (2.0 * shape[0],))])


def misreads(motion: Motion, shape: Shape) -> FloatArray:
    """Cosine and sine of the encoder's turn; what goes by speed is no angle."""
    phase = shape[0] * motion.position
    return np.array([np.cos(phase), np.sin(phase)])


def _rates(motion: Motion, order: float) -> list[FloatArray]:
    """Rates of change of the cosine and sine of the encoder's turn."""
    phase = order * motion.position
    return [rate_of_change(part, 1.0 / motion.step_s) for part in (np.cos(phase), np.sin(phase))]


EFFECT = Effect(
    name="encoder_eccentricity",
    title="Encoder eccentricity",
    physics=(
        "A disc or magnet off its centre reads an angle that swings once a turn: the model sees accelerations "
        "and speeds that never were, and so does a current that is estimated from the speed."
    ),
    equation=r"J\,\frac{d^2}{dt^2}(a\cos nq + b\sin nq) + \frac{d}{dt}(c\cos nq + d\sin nq)",
    columns=columns,
    parameters=(
        Parameter("cosine part", "{position}"),
        Parameter("sine part", "{position}"),
        Parameter("cosine part, by speed", "{effort} s"),
        Parameter("sine part, by speed", "{effort} s"),
    ),
    driver="position",
    excited_by="steady speeds at which a turn of the encoder lies within the pass band",
    source="common in magnetic encoders",
    shapes=shapes,
    shape_names=("encoder turns per joint turn",),
    confused_with=("cogging",),
    facts=("sensor_turns",),
    pipeline=True,
    builds_on="inertia",
    discrepancy=discrepancy,
    misreads=misreads,
)
