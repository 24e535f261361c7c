"""Which rows of a trial are sliding, in transition, or stuck.

A stuck joint constrains the effort only to an interval, so its rows are no equations. Near a reversal, pre-sliding,
backlash and lag dominate. Only steady sliding rows rank effects (Armstrong, Dupont, Canudas de Wit 1994).
"""

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from compensator.lab.recordings.recording import BoolArray, FloatArray

SLIDE_MARGIN_S = 0.04
STUCK_AFTER_S = 0.1
# of the time in which a joint is slow: it passes through rest with half of it below half of `slow`, and turns with 0.7
STANDING_SHARE = 0.6
CARRIED_PERIODS = 0.5  # of the cut-off, to either side: so far the filter carries a step of friction
TRANSIENT_S = 0.15


class Regime(IntEnum):
    """What the joint does in a row."""

    SLIDING = 0
    TRANSIENT = 1
    STUCK = 2


def classify(velocity: FloatArray, slow: float, rate_hz: float, cutoff_hz: float) -> NDArray[np.uint8]:
    """Regime of each row, shape (n,).

    Args:
        velocity: filtered velocity, shape (n,).
        slow: speed below which the direction of motion is uncertain.
        rate_hz: of the rows.
        cutoff_hz: of the final low-pass.
    """
    speed = np.abs(velocity)
    regime = np.full(len(velocity), Regime.TRANSIENT, dtype=np.uint8)
    around_s = 2 * round(SLIDE_MARGIN_S * rate_hz) + 1
    sliding = minimum_filter1d(speed, around_s) > slow
    regime[sliding & ~_after_reversal(velocity, slow, rate_hz)] = Regime.SLIDING
    window = 2 * round(0.5 * STUCK_AFTER_S * rate_hz) + 1
    stuck = minimum_filter1d((speed < slow).astype(np.uint8), window) > 0
    regime[maximum_filter1d(stuck.astype(np.uint8), window) > 0] = Regime.STUCK
    standing = _standing(speed, slow, round(CARRIED_PERIODS / cutoff_hz * rate_hz))
    regime[standing & (regime == Regime.TRANSIENT)] = Regime.STUCK
    return regime


def _standing(speed: FloatArray, slow: float, margin: int) -> BoolArray:
    """Rows of short stops, and of a margin to either side, shape (n,).

    A joint that reverses against dry friction may stand for some hundredths of a second. Friction has any value there,
    and the sign of what the encoder still shows of motion is that of creep.
    """
    edges = np.diff(np.concatenate([[0], (speed < slow).astype(np.int8), [0]]))
    standing = np.zeros(len(speed), dtype=bool)
    for begin, end in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        # of few samples one more or less may fall below the half by chance
        if np.sum(speed[begin:end] < 0.5 * slow) >= STANDING_SHARE * (end - begin) + 1:
            standing[max(0, begin - margin) : end + margin] = True
    return standing


def _after_reversal(velocity: FloatArray, slow: float, rate_hz: float) -> BoolArray:
    """True within TRANSIENT_S after the direction of motion changed."""
    direction = np.where(velocity > slow, 1, np.where(velocity < -slow, -1, 0))
    moving = np.flatnonzero(direction)
    near = np.zeros(len(velocity), dtype=bool)
    changes = moving[1:][np.diff(direction[moving]) != 0]
    after = round(TRANSIENT_S * rate_hz)
    for change in changes:
        near[change : change + after] = True
    return near


def near_flank_change(carried: FloatArray, rate_hz: float) -> BoolArray:
    """Rows within TRANSIENT_S of a change of sign of the torque that the gear carries, shape (n,).

    There the teeth cross their free play and the motor moves alone; filters spread the shock to both sides.

    Args:
        carried: torque, as far as it is known, from the widely filtered motion: bouncing teeth must show. All zero
            where it is not known or there is no free play.
        rate_hz: of the rows.
    """
    sign = np.sign(carried)
    changes = np.zeros(len(carried), dtype=np.uint8)
    changes[1:] = (sign[1:] * sign[:-1]) < 0.0
    near: BoolArray = maximum_filter1d(changes, 2 * round(TRANSIENT_S * rate_hz) + 1) > 0
    return near
