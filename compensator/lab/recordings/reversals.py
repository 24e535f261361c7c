"""What a joint remembers of its reversals and rests: the states behind effects with memory.

Between two turning points the position is monotonic, and the laws below have a closed form over it. So only the
turning points are walked through one by one, not the samples.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from compensator.lab.recordings.recording import FloatArray

REST_S = 0.05  # slower than `slow` for this long is a rest; over this long the rate before a start is taken


@dataclass(frozen=True, slots=True)
class Strokes:
    """A motion cut at its turning points. S strokes over n samples.

    Attributes:
        index: stroke of each sample, shape (n,).
        start: position where each stroke begins, shape (S,).
        sign: +1 or -1, direction of each stroke, shape (S,).
        travel: distance from the start of its stroke of each sample, shape (n,).
    """

    index: NDArray[np.int64]
    start: FloatArray
    sign: FloatArray
    travel: FloatArray


def strokes_of(position: FloatArray) -> Strokes:
    """Cut position (n,) at its turning points; samples that stand belong to the stroke before them."""
    step = np.sign(np.diff(position, prepend=position[0]))
    moving = np.flatnonzero(step)
    if len(moving) == 0:
        return Strokes(np.zeros(len(position), dtype=np.int64), position[:1], np.ones(1), np.zeros(len(position)))
    held = step[moving[np.maximum(np.searchsorted(moving, np.arange(len(step)), side="right") - 1, 0)]]
    turns = np.flatnonzero(np.diff(held) != 0.0) + 1
    index = np.zeros(len(position), dtype=np.int64)
    index[turns] = 1
    index = np.cumsum(index)
    # a stroke begins at the turning point itself: the last sample of the stroke before
    starts = np.concatenate([[0], turns - 1])
    start = position[starts]
    return Strokes(index, start, held[np.concatenate([[0], turns])], np.abs(position - start[index]))


def deflection(strokes: Strokes, distance: float) -> FloatArray:
    """Dahl's pre-sliding state, -1 .. 1, shape (n,): dz/dx = (1 - z sgn(dx)) / distance, from rest at z = 0."""
    ends = _ends(strokes)
    begins = np.zeros(len(strokes.start))
    for k in range(1, len(begins)):
        sign = strokes.sign[k - 1]
        begins[k] = sign + (begins[k - 1] - sign) * np.exp(-ends[k - 1] / distance)
    sign = strokes.sign[strokes.index]
    state: FloatArray = sign + (begins[strokes.index] - sign) * np.exp(-strokes.travel / distance)
    return state


def slider(strokes: Strokes, distance: float) -> FloatArray:
    """How far a spring is bent that slides along once it is bent by a distance, over that, -1 .. 1, shape (n,).

    dz/dx = 1 / distance while |z| < 1, from rest at z = 0: a turn back within a loop closes it where it left.
    """
    ends = _ends(strokes)
    begins = np.zeros(len(strokes.start))
    for k in range(1, len(begins)):
        sign = strokes.sign[k - 1]
        begins[k] = sign * min(sign * begins[k - 1] + ends[k - 1] / distance, 1.0)
    sign = strokes.sign[strokes.index]
    state: FloatArray = sign * np.minimum(sign * begins[strokes.index] + strokes.travel / distance, 1.0)
    return state


def since_rest(
    position: FloatArray, velocity: FloatArray, time_s: FloatArray, slow: float
) -> tuple[FloatArray, FloatArray]:
    """Length of the last rest [s] and distance travelled since it, shape (n,) each; 0 and inf before the first rest."""
    resting = np.abs(velocity) < slow
    edges = np.diff(np.concatenate([[0], resting.astype(np.int8), [0]]))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    lengths = time_s[ends - 1] - time_s[begins] if len(ends) else np.empty(0)
    begins, ends, lengths = begins[lengths >= REST_S], ends[lengths >= REST_S], lengths[lengths >= REST_S]
    if len(ends) == 0:
        return np.zeros(len(position)), np.full(len(position), np.inf)
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(position)))])
    last = np.searchsorted(ends, np.arange(len(position)), side="right") - 1
    known = last >= 0
    dwell = np.where(known, lengths[np.maximum(last, 0)], 0.0)
    travel = np.where(known, path - path[ends[np.maximum(last, 0)] - 1], np.inf)
    return dwell, travel


def start_rate(effort: FloatArray, velocity: FloatArray, rate_hz: float, slow: float) -> FloatArray:
    """At which rate, over REST_S, the effort changed when the joint last stood or turned, shape (n,); NaN before that.

    Args:
        effort: as measured, shape (n,).
        velocity: shape (n,).
        rate_hz: of the samples.
        slow: speed below which the joint stands.
    """
    span = max(1, round(REST_S * rate_hz))
    rate = np.full(len(effort), np.nan)
    rate[span:] = np.abs(effort[span:] - effort[:-span]) * rate_hz / span
    known = (np.abs(velocity) < slow) & np.isfinite(rate)
    last = np.maximum.accumulate(np.where(known, np.arange(len(effort)), -1))
    return np.where(last >= 0, rate[np.maximum(last, 0)], np.nan)


def _ends(strokes: Strokes) -> FloatArray:
    """Length of each stroke, shape (S,)."""
    longest = np.zeros(len(strokes.start))
    np.maximum.at(longest, strokes.index, strokes.travel)
    return longest
