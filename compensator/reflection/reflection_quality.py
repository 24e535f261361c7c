"""How well a load is reflected, from recorded samples: error, delay, drag, and whether a joint swings without end."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
LEAST_TURNS = 4  # two periods
JUMP_SAMPLES = 4  # within which a jump is over
SUDDEN = 0.5  # of a jump, within that
LEVEL_SAMPLES = 10  # that tell a level
RISEN = 0.5
LEAST_CORRELATION = 0.5  # below, what is reflected is no image of the truth, and has no delay


class Swing(NamedTuple):
    """How a position moves while it should rest.

    Attributes:
        amplitude_rad: half of what lies between its extremes.
        turns: how often it turned back by more than the threshold.
    """

    amplitude_rad: float
    turns: int

    @property
    def is_limit_cycle(self) -> bool:
        """Whether it goes on swinging: it turned back at least `LEAST_TURNS` times."""
        return self.turns >= LEAST_TURNS


def swing(position_rad: FloatArray, threshold_rad: float) -> Swing:
    """How a position swings.

    Args:
        position_rad: samples of a time in which it should rest, shape (n,); at least one.
        threshold_rad: what is less is noise of the encoder.
    """
    low = high = extreme = float(position_rad[0])
    way, turns = 0, 0
    for position in position_rad.tolist():
        if way == 0:
            low, high = min(low, position), max(high, position)
            way = int(position > low + threshold_rad) - int(position < high - threshold_rad)
            extreme = position
        elif way * (position - extreme) >= 0.0:
            extreme = position
        elif way * (extreme - position) > threshold_rad:
            way, turns, extreme = -way, turns + 1, position
    return Swing(float(np.ptp(position_rad)) / 2.0, turns)


def delay_s(reflected: FloatArray, truth: FloatArray, period_s: float, longest_s: float = 0.5) -> float | None:
    """By how much what is reflected comes later than the truth: where the two correlate best.

    Args:
        reflected: samples of one motion, one period apart, shape (n,); finite.
        truth: at the same times.
        period_s: of the samples.
        longest_s: most delay that is looked for, and most lead.

    Returns:
        The delay [s], between samples by a parabola; None where the two correlate by less than `LEAST_CORRELATION`
        everywhere, or best at the edge, or where what is reflected comes a sample or more before its cause.
    """
    most = min(round(longest_s / period_s), len(truth) // 2)
    alike = np.array([_correlation(*_shifted(reflected, truth, lag)) for lag in range(-most, most + 1)])
    best = int(np.argmax(alike))
    if not alike[best] >= LEAST_CORRELATION or best < most or best == len(alike) - 1:
        return None
    before, at, after = alike[best - 1 : best + 2]
    bend = before - 2.0 * at + after
    return float((best - most + (0.5 * (before - after) / bend if bend < 0.0 else 0.0)) * period_s)


def unexplained(reflected: FloatArray, truth: FloatArray, latest: int) -> FloatArray:
    """How far what is reflected lies outside of all that the truth was within the last few samples, shape (n,).

    Args:
        reflected: samples, shape (n,); finite.
        truth: at the same times.
        latest: samples of delay that are no error.
    """
    padded = np.concatenate([np.full(latest, truth[0]), truth])
    recent = np.lib.stride_tricks.sliding_window_view(padded, latest + 1)
    outside = np.maximum(np.min(recent, axis=1) - reflected, reflected - np.max(recent, axis=1))
    return np.asarray(np.maximum(outside, 0.0))


def rise_s(reflected: FloatArray, truth: FloatArray, period_s: float, least_jump: float) -> float | None:
    """From the greatest jump of the truth until half of it is reflected [s].

    The truth is taken from the median before to the median after: what a hit does for a moment is no level.

    Returns:
        None where the truth nowhere jumps by the least jump, or it is not reflected.
    """
    lead, settle = LEVEL_SAMPLES, JUMP_SAMPLES
    jumps = {
        k: float(np.median(truth[k + settle : k + settle + lead]) - np.median(truth[k - lead : k]))
        for k in range(lead, len(truth) - lead - settle)
        # what takes longer is no jump
        if abs(truth[k + settle] - truth[k - 1]) >= least_jump
    }
    sudden = {k: jump for k, jump in jumps.items() if abs(truth[k + settle] - truth[k - 1]) >= SUDDEN * abs(jump)}
    if not sudden:
        return None
    place, jump = max(sudden.items(), key=lambda one: abs(one[1]))
    if abs(jump) < least_jump:
        return None
    way, before = (1.0 if jump > 0.0 else -1.0), float(np.median(truth[place - lead : place]))
    # the jump begins where the truth leaves the level before it by a tenth
    left = np.flatnonzero(way * (truth[place:] - before) > 0.1 * abs(jump))
    risen = np.flatnonzero(way * (reflected[place + left[0] :] - before) >= RISEN * abs(jump))
    return float(risen[0] * period_s) if len(risen) else None


def drag(reflected: FloatArray, truth: FloatArray, hand_rad: FloatArray) -> float:
    """Torque with which what is reflected resists the hand more than the truth does, mean over the hand's way.

    Below 0 it drives the hand on: then hand and master have to take the energy, or the pair swings. In haptics this is
    the balance of a passivity observer (Hannaford and Ryu, IEEE Trans. Robot. Autom. 18 (2002), 1) over the way.

    Args:
        reflected: samples, shape (n,); finite.
        truth: at the same times.
        hand_rad: angle of the master's arm, at the same times.
    """
    step = np.diff(hand_rad)
    way = float(np.sum(np.abs(step)))
    return float(np.sum((reflected - truth)[1:] * step)) / way if way > 0.0 else 0.0


def _shifted(reflected: FloatArray, truth: FloatArray, lag: int) -> tuple[FloatArray, FloatArray]:
    """What is reflected, beside the truth that was so many samples before."""
    if lag >= 0:
        return reflected[lag:], truth[: len(truth) - lag]
    return reflected[:lag], truth[-lag:]


def _correlation(one: FloatArray, other: FloatArray) -> float:
    one, other = one - np.mean(one), other - np.mean(other)
    size = float(np.sqrt(np.sum(one**2) * np.sum(other**2)))
    return float(np.sum(one * other)) / size if size > 0.0 else 0.0
