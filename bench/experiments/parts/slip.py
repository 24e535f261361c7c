"""When a joint that is pushed harder and harder lets go."""

from math import ceil

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
LEAST_COUNTS = 3.0  # that the slip speed makes between two positions compared; fewer may be noise


def comparing_cycles(slip_speed_rad_s: float, period_s: float, count_rad: float) -> int:
    """Over how many cycles a speed can be told from rest."""
    return max(1, ceil(LEAST_COUNTS * count_rad / (slip_speed_rad_s * period_s)))


def slip_index(way_rad: FloatArray, slip_speed_rad_s: float, period_s: float, count_rad: float) -> int:
    """The last reading before the joint slips: from there on it is faster than the slip speed, to the end of the push.

    Args:
        way_rad: along the push, shape (n,); it ends beyond all free play.
        slip_speed_rad_s: speed that pre-sliding and creep stay below.
        period_s: of control.
        count_rad: of the encoder, at the joint.

    Returns:
        An index of `way_rad`; 0 where it slips from the start.
    """
    cycles = comparing_cycles(slip_speed_rad_s, period_s, count_rad)
    moved_rad = way_rad[cycles:] - way_rad[:-cycles]
    slow = np.flatnonzero(moved_rad <= slip_speed_rad_s * cycles * period_s)
    return int(slow[-1]) + cycles if len(slow) else 0
