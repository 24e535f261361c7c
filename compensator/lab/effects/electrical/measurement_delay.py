"""Measurement delay."""

import numpy as np
from numba import njit

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

SHORT = 1e-3  # of a sample: less changes nothing


def columns(motion: Motion, _: Shape) -> FloatArray:
    """What the predicted effort changes by within the delay that the model has, over it: its rate where that is none.

    To first order alone, a delay of 20 ms would leave as much of a motion of some hertz as a small effect does. The
    model's delay is found anew with every fit, until it stays (secant).
    """
    late_s = motion.late_s
    if abs(late_s) < SHORT * motion.step_s:
        return motion.effort_rate[None]
    return _later(motion.predicted, motion.step_s * motion.effort_rate, late_s / motion.step_s, late_s)[None]


@njit(cache=True)
def _later(effort: FloatArray, slope: FloatArray, steps: float, late_s: float) -> FloatArray:
    """What an effort (n,) changes by so many steps later, over the delay: between samples by cubic Hermite splines.

    Args:
        effort: at every sample.
        slope: its change within a step, at every sample.
        steps: of the delay.
        late_s: the delay.
    """
    last = len(effort) - 1
    whole = int(np.floor(steps))
    x = steps - whole
    onto, up, down = x * x * (3.0 - 2.0 * x), x * (1.0 - x) ** 2, x * x * (1.0 - x)
    column = np.empty(len(effort))
    for row in range(len(effort)):
        here = min(max(row + whole, 0), last)
        there = min(here + 1, last)
        moved = (1.0 - onto) * effort[here] + onto * effort[there] + up * slope[here] - down * slope[there]
        column[row] = (moved - effort[row]) / late_s
    return column


EFFECT = Effect(
    name="measurement_delay",
    title="Measurement delay",
    physics=(
        "The position is older than the effort: the model then sees the motion late, and the effort is that of a "
        "moment later."
    ),
    equation=r"\hat\tau(t + \Delta t) - \hat\tau(t)",
    columns=columns,
    parameters=(Parameter("delay", "s", -0.1, 0.1),),
    driver="effort_rate",
    excited_by="fast reversals and frequencies above 3 Hz",
    source="Gauss-Newton, the delay found anew with each fit",
    confused_with=("inertia",),
    builds_on="effort",
    pipeline=True,
    standing_in=frozenset({"jerk"}),
)
