"""How a joint slows down by itself: dry and viscous deceleration, out of where it was when."""

from dataclasses import dataclass
from math import nan

import numpy as np

from compensator.lab.recordings.recording import FloatArray

LEAST_READINGS = 8
LEAST_SPEED_SHARE = 0.2  # of the first speed: below, friction rises again (Stribeck), and the teeth may part


@dataclass(frozen=True, slots=True)
class CoastFit:
    """dv/dt = -a - v / T, for a speed v above 0.

    Attributes:
        dry_deceleration_rad_s2: a; NaN where there are too few readings.
        time_constant_s: T; NaN where the joint does not slow down more at speed.
        rms_rad: of position against that law.
    """

    dry_deceleration_rad_s2: float
    time_constant_s: float
    rms_rad: float
    readings: int


def fit_coast(time_s: FloatArray, way_rad: FloatArray) -> CoastFit:
    """Fit the law to the fast part of a coast.

    Integrated twice it is x = v0 t - a t^2 / 2 - integral(x) / T, linear in v0, a and 1 / T: the position is not
    differentiated.

    Args:
        time_s: shape (n,).
        way_rad: along the direction of motion, shape (n,).
    """
    fresh = np.diff(time_s, prepend=-np.inf) > 0.0  # a drive that had nothing new told the same reading again
    time_s, way_rad = time_s[fresh], way_rad[fresh]
    count = _fast_part(time_s, way_rad)
    if count < LEAST_READINGS:
        return CoastFit(nan, nan, nan, count)
    time_s, way_rad = time_s[:count] - time_s[0], way_rad[:count] - way_rad[0]
    steps = np.diff(time_s) * (way_rad[1:] + way_rad[:-1]) / 2.0
    integral = np.concatenate([[0.0], np.cumsum(steps)])
    columns = np.column_stack([time_s, -0.5 * time_s**2, -integral])
    found = np.linalg.lstsq(columns, way_rad, rcond=None)[0]
    if found[2] <= 0.0:  # no more at speed: dry friction alone
        columns = columns[:, :2]
        found = np.linalg.lstsq(columns, way_rad, rcond=None)[0]
    rms_rad = float(np.sqrt(np.mean((way_rad - columns @ found) ** 2)))
    time_constant_s = 1.0 / float(found[2]) if len(found) > 2 else nan
    return CoastFit(float(found[1]), time_constant_s, rms_rad, count)


def _fast_part(time_s: FloatArray, way_rad: FloatArray) -> int:
    """Readings before the joint is slow."""
    if len(time_s) < 2:
        return len(time_s)
    speed = np.gradient(way_rad, time_s)
    slow = np.flatnonzero(speed < LEAST_SPEED_SHARE * speed[0])
    return int(slow[0]) if len(slow) else len(time_s)
