"""The zero-phase low-pass that columns and effort go through alike.

A diagnosis filters thousands of columns of short trials. scipy's filter takes one after the other, and each call costs
more than the work; here all columns go side by side through each section, which is the same arithmetic.
"""

from functools import lru_cache

import numpy as np
from numba import njit
from scipy.signal import butter, sosfilt_zi

from compensator.lab.recordings.recording import FloatArray

FILTER_ORDER = 4
PADDING = 3  # times the filter's length, continued at both ends


def low_pass(values: FloatArray, cutoff_hz: float, rate_hz: float) -> FloatArray:
    """Zero-phase Butterworth low-pass; unchanged where the cut-off is beyond Nyquist.

    Args:
        values: shape (n,) or (k, n).
        cutoff_hz: where each of the two passes halves the power.
        rate_hz: of the samples.
    """
    if cutoff_hz >= 0.49 * rate_hz:
        return values
    sections, steady = filter_sections(cutoff_hz, rate_hz)
    padding = PADDING * (2 * len(sections) + 1)
    padded = np.ascontiguousarray(_odd_extension(np.atleast_2d(values), padding).T, dtype=np.float64)
    _there_and_back(sections, steady, padded)
    filtered: FloatArray = np.ascontiguousarray(padded[padding:-padding].T).reshape(values.shape)
    return filtered


@lru_cache(maxsize=256)
def filter_sections(cutoff_hz: float, rate_hz: float) -> tuple[FloatArray, FloatArray]:
    """Second-order sections of the low-pass, and the state of each that a constant 1 settles to."""
    sections: FloatArray = butter(FILTER_ORDER, cutoff_hz, fs=rate_hz, output="sos")
    return sections, sosfilt_zi(sections)


def _odd_extension(values: FloatArray, count: int) -> FloatArray:
    """Values continued at both ends by their own mirror image through the end points."""
    before = 2.0 * values[..., :1] - values[..., count:0:-1]
    after = 2.0 * values[..., -1:] - values[..., -2 : -count - 2 : -1]
    return np.concatenate([before, values, after], axis=-1)


@njit(cache=True)
def _there_and_back(sections: FloatArray, steady: FloatArray, values: FloatArray) -> None:
    """Filter along the first axis of (n, k), forward and backward, each from the steady state of its first value."""
    count, columns = values.shape
    first, second = np.empty((len(sections), columns)), np.empty((len(sections), columns))
    for way in range(2):
        start = values[0] if way == 0 else values[count - 1]
        for section in range(len(sections)):
            for column in range(columns):
                first[section, column] = steady[section, 0] * start[column]
                second[section, column] = steady[section, 1] * start[column]
        for step in range(count):
            row = step if way == 0 else count - 1 - step
            for section in range(len(sections)):
                b0, b1, b2, _, a1, a2 = sections[section]
                for column in range(columns):  # innermost, so that they are done side by side
                    put_in = values[row, column]
                    out = b0 * put_in + first[section, column]
                    first[section, column] = b1 * put_in - a1 * out + second[section, column]
                    second[section, column] = b2 * put_in - a2 * out
                    values[row, column] = out
