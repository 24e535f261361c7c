"""Rates of change of sampled signals.

Plain central differences lose (w T)^2 / 6 of a rate at angular frequency w: twice applied, at a cut-off of an eighth of
the sampling rate, a tenth of the acceleration, which then looks like an elastic joint. Eighth-order differences lose
(w T)^8 / 630 (Fornberg 1988).
"""

from collections.abc import Sequence

import numpy as np
from numba import njit
from scipy.interpolate import CubicHermiteSpline

from compensator.lab.recordings.recording import FloatArray, IntArray

WEIGHTS = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)  # of the differences over 2, 4, 6, 8 samples


def rate_of_change(values: FloatArray, rate_hz: float) -> FloatArray:
    """Derivative of values (n,) sampled at a uniform rate; of second order in the four samples at each end."""
    reach = len(WEIGHTS)
    if len(values) <= 2 * reach + 2:
        few: FloatArray = np.gradient(values, 1.0 / rate_hz)
        return few
    derived = np.empty(len(values))
    _differences(np.asarray(values, dtype=np.float64), rate_hz, derived)
    return derived


def rates_of_change(values: FloatArray, parts: Sequence[slice], rates_hz: Sequence[float]) -> FloatArray:
    """The same of values (m,) of several trials, one after the other, each at its own rate; all at once."""
    derived = np.empty(len(values))
    if min((part.stop - part.start for part in parts), default=0) <= 2 * len(WEIGHTS) + 2:
        for part, rate_hz in zip(parts, rates_hz, strict=True):
            derived[part] = rate_of_change(values[part], rate_hz)
        return derived
    ends = np.array([parts[0].start, *(part.stop for part in parts)])
    _differences_of_each(values, ends, np.array(rates_hz), derived)
    return derived


@njit(cache=True)
def _differences_of_each(values: FloatArray, ends: IntArray, rates_hz: FloatArray, derived: FloatArray) -> None:
    for index in range(len(rates_hz)):
        own = slice(ends[index], ends[index + 1])
        _differences(values[own], rates_hz[index], derived[own])


@njit(cache=True)
def _differences(values: FloatArray, rate_hz: float, derived: FloatArray) -> None:
    reach, last, step_s = len(WEIGHTS), len(values) - 1, 1.0 / rate_hz
    one, two, three, four = WEIGHTS
    derived[0] = (values[1] - values[0]) / step_s
    derived[last] = (values[last] - values[last - 1]) / step_s
    for row in range(1, reach):
        derived[row] = (values[row + 1] - values[row - 1]) / (2.0 * step_s)
        derived[last - row] = (values[last - row + 1] - values[last - row - 1]) / (2.0 * step_s)
    for row in range(reach, len(values) - reach):
        # written out, so that a processor does several rows at once
        total = one * (values[row + 1] - values[row - 1]) + two * (values[row + 2] - values[row - 2])
        total += three * (values[row + 3] - values[row - 3])
        total += four * (values[row + 4] - values[row - 4])
        derived[row] = total * rate_hz


def later(values: FloatArray, late_s: float, rate_hz: float) -> FloatArray:
    """Values (n,) a time later, between samples by cubic Hermite splines; the last one beyond the end."""
    time_s = np.arange(len(values)) / rate_hz
    spline = CubicHermiteSpline(time_s, values, rate_of_change(values, rate_hz))
    found: FloatArray = spline(np.clip(time_s + late_s, 0.0, time_s[-1]))
    return found
