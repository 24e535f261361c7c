"""The zero-phase low-pass that columns and effort go through alike, and a band-pass that is filtered as they are.

A diagnosis filters thousands of columns of short trials. scipy's filter takes one after the other, and each call costs
more than the work; here all columns, of one trial or of many, go side by side through each section, which is the same
arithmetic.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import groupby

import numpy as np
from numba import njit
from scipy.signal import butter, sosfilt_zi

from compensator.lab.recordings.recording import FloatArray, IntArray

FILTER_ORDER = 4
TURNED_AT_ONCE = 8  # rows: what a line of the cache holds
PASSES_ALL = 0.49  # of the sampling rate: from there on nothing is taken away
TOP_OF_BAND = 0.45  # of the sampling rate: no band goes higher
PADDING = 3  # times the filter's length, continued at both ends


def low_pass(values: FloatArray, cutoff_hz: float, rate_hz: float) -> FloatArray:
    """Zero-phase Butterworth low-pass; unchanged where the cut-off is beyond Nyquist.

    Args:
        values: shape (n,) or (k, n).
        cutoff_hz: where each of the two passes halves the power.
        rate_hz: of the samples.
    """
    if cutoff_hz >= PASSES_ALL * rate_hz:
        return values
    rows = np.atleast_2d(values).astype(np.float64, copy=False)
    filtered = low_pass_thinned([rows], cutoff_hz, [rate_hz], [np.arange(rows.shape[1])])
    return np.ascontiguousarray(filtered.T).reshape(values.shape)


def low_pass_thinned(
    blocks: Sequence[FloatArray], cutoff_hz: float, rates_hz: Sequence[float], picked: Sequence[IntArray]
) -> FloatArray:
    """The same for the blocks (k, n) of several trials, each of its own length and rate, all at once; thinned.

    Columns of zeros, as orders that an effect does not use, stay what they are.

    Args:
        blocks: all of as many columns, k.
        cutoff_hz: as `low_pass`.
        rates_hz: of each block's samples.
        picked: which samples of each block are wanted, rising.

    Returns:
        The picked samples of all blocks, one after the other, shape (N, k).
    """
    untouched = [index for index, rate_hz in enumerate(rates_hz) if cutoff_hz >= PASSES_ALL * rate_hz]
    return _filtered_thinned(blocks, cutoff_hz, rates_hz, picked, untouched)


def band_pass_thinned(
    values: FloatArray, low_hz: float, high_hz: float, rate_hz: float, picked: IntArray
) -> FloatArray:
    """The same between two frequencies, for one trial's columns (k, n): shape (N, k)."""
    return _filtered_thinned([values], (low_hz, high_hz), [rate_hz], [picked], [])


def _filtered_thinned(
    blocks: Sequence[FloatArray],
    passed_hz: float | tuple[float, float],
    rates_hz: Sequence[float],
    picked: Sequence[IntArray],
    untouched: Sequence[int],
) -> FloatArray:
    whole = np.concatenate(blocks, axis=1)
    ends = np.cumsum([0, *(len(one) for one in picked)])
    thinned = np.zeros((ends[-1], len(whole)))
    used = _used(whole)
    if not len(used):
        return thinned
    starts = np.cumsum([0, *(block.shape[1] for block in blocks)])
    lengths = np.diff(starts)
    for index in untouched:
        thinned[ends[index] : ends[index + 1]] = blocks[index].T[picked[index]]
    # the longest first, so that the columns that have begun stand side by side
    some = [int(index) for index in np.argsort(-lengths, kind="stable") if index not in untouched and lengths[index]]
    if not some:
        return thinned
    designs, steady, ends_of = _designs(passed_hz, tuple(rates_hz[index] for index in some), len(used))
    padding = PADDING * (FILTER_ORDER + 1)
    longest = int(lengths[some[0]]) + 2 * padding
    first_rows = longest - 2 * padding - lengths[some]
    together = np.empty((longest, len(used) * len(some)))
    _put_with_odd_extension(whole, used, starts[some], lengths[some], together, padding)
    _there_and_back(designs, steady, ends_of, np.repeat(first_rows, len(used)), together)
    chosen = [picked[index] for index in some]
    counts = np.array([len(one) for one in chosen])
    _take(together, np.concatenate(chosen), counts, first_rows + padding, ends[some], used, thinned)
    return thinned


def _used(columns: FloatArray) -> IntArray:
    """Which columns (k, n) hold anything."""
    # most are seen at once, by the middle sample
    seen = columns[:, columns.shape[1] // 2 : columns.shape[1] // 2 + 1].any(axis=1)
    return np.flatnonzero(seen if seen.all() else columns.any(axis=1))


@lru_cache(maxsize=256)  # trials of one bench have one rate, and the design takes longer than the filtering
def filter_sections(passed_hz: float | tuple[float, float], rate_hz: float) -> tuple[FloatArray, FloatArray]:
    """Second-order sections of the low-pass, and the state of each that a constant 1 settles to.

    Args:
        passed_hz: up to where, or between which two frequencies: a band-pass of half the order has as many sections.
        rate_hz: of the samples.
    """
    sections: FloatArray
    if isinstance(passed_hz, tuple):
        low_hz, high_hz = passed_hz
        band_hz = (low_hz, min(high_hz, TOP_OF_BAND * rate_hz))
        sections = butter(FILTER_ORDER // 2, band_hz, btype="bandpass", fs=rate_hz, output="sos")
    else:
        sections = butter(FILTER_ORDER, passed_hz, fs=rate_hz, output="sos")
    return sections, sosfilt_zi(sections)


@lru_cache(maxsize=256)
def _designs(
    passed_hz: float | tuple[float, float], rates_hz: tuple[float, ...], width: int
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Filters of blocks of such rates and a width, those side by side that are alike once.

    A fit asks for the same trials side by side again and again.

    Returns:
        Both sections of each, (designs, 2, 6); the states that a constant 1 settles to, (designs, 4); and the columns
        that each ends at, (designs,).
    """
    alike = [(rate_hz, len(list(group))) for rate_hz, group in groupby(rates_hz)]
    found = [filter_sections(passed_hz, rate_hz) for rate_hz, _ in alike]
    designs, steady = (np.array(kind) for kind in zip(*found, strict=True))
    return designs, steady.reshape(len(alike), 4), width * np.cumsum([count for _, count in alike])


@njit(cache=True)
def _put_with_odd_extension(
    whole: FloatArray, used: IntArray, starts: IntArray, lengths: IntArray, into: FloatArray, count: int
) -> None:
    """Blocks of rows (k, m), each continued at both ends by its own mirror image through the end points.

    Args:
        whole: the blocks, side by side.
        used: rows of them that are wanted.
        starts: of each block.
        lengths: of each block.
        into: columns that all end together, those of one block beside each other; shape (longest, len(used) * blocks).
        count: values that are continued by.
    """
    width = len(used)
    for block in range(len(starts)):
        start, last, left = starts[block], lengths[block] - 1, block * width
        top = len(into) - lengths[block] - count
        # some samples of all columns at a time: what is read and what is written both stay near
        for first in range(0, last + 1, TURNED_AT_ONCE):
            some = min(TURNED_AT_ONCE, last + 1 - first)
            turned = into[top + first : top + first + some, left : left + width]
            for column in range(width):
                given = whole[used[column], start + first : start + first + some]
                for row in range(some):  # of views, whose indices are not looked at for being negative
                    turned[row, column] = given[row]
        for away in range(1, count + 1):
            for column in range(width):
                own = used[column]
                into[top - away, left + column] = 2.0 * whole[own, start] - whole[own, start + away]
                end = start + last
                into[top + last + away, left + column] = 2.0 * whole[own, end] - whole[own, end - away]


@njit(cache=True)
def _take(
    filtered: FloatArray,
    picked: IntArray,
    counts: IntArray,
    tops: IntArray,
    ends: IntArray,
    used: IntArray,
    thinned: FloatArray,
) -> None:
    """The picked samples of blocks of filtered columns, to where each block's rows begin.

    Args:
        filtered: as `_put_with_odd_extension` has laid them out.
        picked: samples of all blocks, one after the other.
        counts: of them, by block.
        tops: row of each block's first sample.
        ends: first row of each block in `thinned`.
        used: columns of `thinned` that are filled.
        thinned: filled, shape (N, k).
    """
    width, place = len(used), 0
    for block in range(len(counts)):
        for row in range(counts[block]):
            sample = tops[block] + picked[place]
            place += 1
            for column in range(width):
                thinned[ends[block] + row, used[column]] = filtered[sample, block * width + column]


@njit(cache=True)
def _there_and_back(
    designs: FloatArray, steady: FloatArray, ends: IntArray, first_rows: IntArray, values: FloatArray
) -> None:
    """Filter along the first axis of (n, k), forward and backward, each from the steady state of its first value.

    Args:
        designs: of filters, shape (designs, 2, 6).
        steady: states that a constant 1 settles to, shape (designs, 4).
        ends: columns that each design ends at, shape (designs,).
        first_rows: where each column begins, rising; all end together; shape (k,).
        values: replaced, shape (n, k).
    """
    count, columns = values.shape
    state = np.empty((4, columns))
    begun = 0
    for row in range(count):
        before = begun
        while begun < columns and first_rows[begun] <= row:
            begun += 1
        _settle(steady, ends, state, values[row], before, begun)
        _step(designs, ends, state, values[row], begun)
    _settle(steady, ends, state, values[count - 1], 0, columns)
    for row in range(count - 1, -1, -1):
        while begun > 0 and first_rows[begun - 1] > row:
            begun -= 1
        _step(designs, ends, state, values[row], begun)


@njit(cache=True, inline="always")
def _settle(steady: FloatArray, ends: IntArray, state: FloatArray, line: FloatArray, first: int, end: int) -> None:
    """Columns of a row, from one on, begin at the state that their value would settle to."""
    start = 0
    for design in range(len(ends)):
        for column in range(max(start, first), min(ends[design], end)):
            for part in range(4):
                state[part, column] = steady[design, part] * line[column]
        start = ends[design]


@njit(cache=True, inline="always")
def _step(designs: FloatArray, ends: IntArray, state: FloatArray, line: FloatArray, begun: int) -> None:
    """A row goes through both sections, each a transposed direct form.

    A design's numbers are at hand for all of its columns: to read them with each value takes longer than to filter it.
    """
    start = 0
    for design in range(len(ends)):
        end = max(min(ends[design], begun), start)
        one, other = designs[design, 0], designs[design, 1]
        b0, b1, b2, a1, a2 = one[0], one[1], one[2], one[4], one[5]
        d0, d1, d2, c1, c2 = other[0], other[1], other[2], other[4], other[5]
        own, p, q = line[start:end], state[0, start:end], state[1, start:end]
        r, s = state[2, start:end], state[3, start:end]
        for column in range(end - start):  # innermost, and of views that begin at 0: they are done side by side
            put_in = own[column]
            between = b0 * put_in + p[column]
            p[column] = b1 * put_in - a1 * between + q[column]
            q[column] = b2 * put_in - a2 * between
            out = d0 * between + r[column]
            r[column] = d1 * between - c1 * out + s[column]
            s[column] = d2 * between - c2 * out
            own[column] = out
        start = ends[design]
