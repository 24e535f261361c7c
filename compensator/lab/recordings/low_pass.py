"""The zero-phase low-pass that columns and effort go through alike.

A diagnosis filters thousands of columns of short trials. scipy's filter takes one after the other, and each call costs
more than the work; here all columns, of one trial or of many, go side by side through each section, which is the same
arithmetic.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numba import njit
from scipy.signal import butter, sosfilt_zi

from compensator.lab.recordings.recording import FloatArray, IntArray

FILTER_ORDER = 4
TURNED_AT_ONCE = 8  # rows: what a line of the cache holds
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
    [filtered] = low_pass_each([np.atleast_2d(values)], cutoff_hz, [rate_hz])
    return np.ascontiguousarray(filtered).reshape(values.shape)


def low_pass_each(blocks: Sequence[FloatArray], cutoff_hz: float, rates_hz: Sequence[float]) -> list[FloatArray]:
    """The same for several blocks (k, n), as of several trials, each of its own length and rate; all at once."""
    found = list(blocks)
    some = [index for index, rate_hz in enumerate(rates_hz) if cutoff_hz < 0.49 * rate_hz and blocks[index].size]
    if not some:
        return found
    # the longest first, so that the columns that have begun stand side by side
    some.sort(key=lambda index: -blocks[index].shape[1])
    widths = tuple(len(blocks[index]) for index in some)
    sections, steady = _sections_of_columns(cutoff_hz, tuple(rates_hz[index] for index in some), widths)
    padding = PADDING * (2 * len(sections) + 1)
    lengths = [blocks[index].shape[1] + 2 * padding for index in some]
    first_rows = lengths[0] - np.array(lengths)
    together = np.empty((lengths[0], sum(widths)))
    parts = []
    for index, first, part in zip(some, first_rows, np.split(together, np.cumsum(widths)[:-1], axis=1), strict=True):
        _put_with_odd_extension(blocks[index], part[first:], padding)
        parts.append((index, part[first + padding : lengths[0] - padding].T))
    _there_and_back(sections, steady, np.repeat(first_rows, widths), together)
    for index, part in parts:
        found[index] = part
    return found


@lru_cache(maxsize=256)
def filter_sections(cutoff_hz: float, rate_hz: float) -> tuple[FloatArray, FloatArray]:
    """Second-order sections of the low-pass, and the state of each that a constant 1 settles to."""
    sections: FloatArray = butter(FILTER_ORDER, cutoff_hz, fs=rate_hz, output="sos")
    return sections, sosfilt_zi(sections)


@lru_cache(maxsize=256)
def _sections_of_columns(
    cutoff_hz: float, rates_hz: tuple[float, ...], widths: tuple[int, ...]
) -> tuple[FloatArray, FloatArray]:
    """Those of each column of blocks of such rates and widths, (sections, 6, k) and (sections, 2, k).

    A fit asks for the same trials side by side again and again.
    """
    designs = [filter_sections(cutoff_hz, rate_hz) for rate_hz in rates_hz]
    sections, steady = (np.repeat(kind, widths, axis=0).transpose(1, 2, 0) for kind in zip(*designs, strict=True))
    return np.ascontiguousarray(sections), np.ascontiguousarray(steady)


@njit(cache=True)
def _put_with_odd_extension(values: FloatArray, into: FloatArray, count: int) -> None:
    """Values (k, n) as columns, continued at both ends by their own mirror image through the end points."""
    columns, last = values.shape[0], values.shape[1] - 1
    # some rows of all columns at a time: what is read and what is written both stay near
    for start in range(0, last + 1, TURNED_AT_ONCE):
        for column in range(columns):
            for row in range(start, min(start + TURNED_AT_ONCE, last + 1)):
                into[count + row, column] = values[column, row]
    for away in range(1, count + 1):
        for column in range(columns):
            into[count - away, column] = 2.0 * values[column, 0] - values[column, away]
            into[count + last + away, column] = 2.0 * values[column, last] - values[column, last - away]


@njit(cache=True)
def _there_and_back(sections: FloatArray, steady: FloatArray, first_rows: IntArray, values: FloatArray) -> None:
    """Filter along the first axis of (n, k), forward and backward, each from the steady state of its first value.

    Args:
        sections: of each column's filter, shape (sections, 6, k).
        steady: state that a constant 1 settles to, shape (sections, 2, k).
        first_rows: where each column begins, rising; all end together; shape (k,).
        values: replaced, shape (n, k).
    """
    count, columns = values.shape
    first, second = np.empty((len(sections), columns)), np.empty((len(sections), columns))
    begun = 0
    for row in range(count):
        while begun < columns and first_rows[begun] <= row:
            _settle(steady, first, second, values, row, begun)
            begun += 1
        _step(sections, first, second, values, row, begun)
    for column in range(columns):
        _settle(steady, first, second, values, count - 1, column)
    for row in range(count - 1, -1, -1):
        while begun > 0 and first_rows[begun - 1] > row:
            begun -= 1
        _step(sections, first, second, values, row, begun)


@njit(cache=True, inline="always")
def _settle(
    steady: FloatArray, first: FloatArray, second: FloatArray, values: FloatArray, row: int, column: int
) -> None:
    for section in range(len(steady)):
        first[section, column] = steady[section, 0, column] * values[row, column]
        second[section, column] = steady[section, 1, column] * values[row, column]


@njit(cache=True, inline="always")
def _step(
    sections: FloatArray, first: FloatArray, second: FloatArray, values: FloatArray, row: int, begun: int
) -> None:
    for section in range(len(sections)):
        b0, b1, b2 = sections[section, 0], sections[section, 1], sections[section, 2]
        a1, a2 = sections[section, 4], sections[section, 5]
        for column in range(begun):  # innermost, so that they are done side by side
            put_in = values[row, column]
            out = b0[column] * put_in + first[section, column]
            first[section, column] = b1[column] * put_in - a1[column] * out + second[section, column]
            second[section, column] = b2[column] * put_in - a2[column] * out
            values[row, column] = out
