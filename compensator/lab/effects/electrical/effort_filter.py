"""Effort that was filtered before it was recorded."""

import numpy as np
from scipy.signal import lfilter

from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.recordings.recording import FloatArray

# 1 is all of it; beside a model that was fitted to smoothed effort the first step is several times too long, and a
# small share of a long time constant is what any chain leaves of a delay to second order
LEAST_SHARE, MOST_SHARE = 0.5, 10.0
SHORTEST_S, LONGEST_S = 0.008, 0.5  # a shorter one is a delay to second order; a longer one would show no motion


def shapes(_: Motion) -> list[Shape]:
    """Time constants, some four to a decade."""
    return [(float(time_s),) for time_s in np.geomspace(SHORTEST_S, LONGEST_S, 8)]


def columns(motion: Motion, shape: Shape) -> FloatArray:
    """What a low-pass of first order, of shape (time constant [s],), adds to the predicted effort."""
    if len(motion.predicted) < 2:
        return np.zeros((1, len(motion.predicted)))
    kept = np.exp(-motion.step_s / shape[0])
    start = kept * motion.predicted[:1]  # settled where the trial begins
    filtered, _ = lfilter([1.0 - kept], [1.0, -kept], motion.predicted, zi=start)
    found: FloatArray = filtered - motion.predicted
    return found[None]


EFFECT = Effect(
    name="effort_filter",
    title="Filtered effort",
    physics=(
        "The drive smooths the current that it reports, or a logger the channel, and the position is not smoothed as "
        "much: what passes quickly comes out small and late. A delay alone makes it late, but not small."
    ),
    equation=r"-s\,\frac{T\,d/dt}{1 + T\,d/dt}\,\hat\tau",
    columns=columns,
    parameters=(Parameter("share of the effort that is filtered", "", LEAST_SHARE, MOST_SHARE),),
    driver="effort_rate",
    excited_by="the same path at several speeds",
    source="low-pass of first order",
    shapes=shapes,
    smooth_shape=True,
    shape_names=("time constant",),
    shape_units=("s",),
    confused_with=("measurement_delay", "inertia"),
    builds_on="effort",
    pipeline=True,
    efforts=("current", "torque"),  # what a drive measures; a duty or a voltage is what it was told
    standing_in=frozenset({"jerk"}),
    ends_within_scan=1,
)
