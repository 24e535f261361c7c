"""Breakaway events of recordings: where a joint at rest begins to slide, and under which effort.

Sliding rows cannot see what happens before sliding. Here every start from rest is one row: the effort at the last
moment of rest, how long the rest was, how quickly the effort rose, which way it went. Creep below the slow speed is
still rest (pre-sliding); a start is what goes on to slide (Armstrong, Dupont, Canudas de Wit 1994).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import stdtrit

from compensator.lab.recordings.processing import Signals
from compensator.lab.recordings.recording import BoolArray, FloatArray

REST_S = 0.2  # slower than `slow` for this long is a rest; less is a turning point
COUNTS = 3.0  # that `slow` makes between two positions compared: fewer may be the encoder's
TRAVEL_COUNTS = 10.0  # of a start, at least
TRAVEL_S = 0.1  # that a start lasts, at `slow`, at least
WINDOWS_S = (0.05, 0.1, 0.2, 0.4)  # over which a line is laid through the effort before the start
CURVED = 3.0  # t value of a bend that makes a window too long
JUMPED = 0.01  # chance that noise brings an effort so far from the line through those before it
FEWEST_SAMPLES = 4


@dataclass(frozen=True, slots=True)
class Start:
    """One motion out of rest, of one trial.

    Attributes:
        index: of the last sample at rest, in the trial's signals.
        direction: 1 or -1, of the motion.
        effort: at that sample, from a line through those before it, in the effort's unit.
        effort_sd: standard deviation of that, by the scatter about the line, or by how far the effort jumped.
        rate: of the effort, along the motion [effort/s].
        rest_s: how long the joint had been at rest by then.
        turns_back: whether the joint goes back the way it came from.
    """

    index: int
    direction: float
    effort: float
    effort_sd: float
    rate: float
    rest_s: float
    turns_back: bool = False


def starts_of(signals: Signals, position: FloatArray, count: float, slow: float) -> list[Start]:
    """Every start from rest of a trial.

    Args:
        signals: of the trial.
        position: not filtered, on the signals' grid, shape (n,).
        count: resolution of position.
        slow: speed below which the joint is at rest.
    """
    period_s = 1.0 / signals.rate_hz
    least = max(TRAVEL_COUNTS * count, TRAVEL_S * slow)
    rests = rests_of(signals, position, count, slow)
    found = []
    for (begin, end), (after, _) in pairwise([*rests, (len(position) - 1, 0)]):
        way = position[end : after + 1] - position[end]
        gone = np.flatnonzero(np.abs(way) >= least)
        if (end - begin) * period_s >= REST_S and len(gone) and signals.usable[end]:
            direction = float(np.sign(way[gone[0]]))
            found.append(_start(signals, begin, end, direction, _came_from(position, begin, least) == direction))
    return [start for start in found if start is not None]


def _came_from(position: FloatArray, begin: int, least: float) -> float:
    """On which side of a rest that begins at a sample the joint was before, 1 or -1; 0 where it was at rest before."""
    way = position[: begin + 1] - position[begin]
    far = np.flatnonzero(np.abs(way) >= least)
    return float(np.sign(way[far[-1]])) if len(far) else 0.0


def rests_of(signals: Signals, position: FloatArray, count: float, slow: float) -> list[tuple[int, int]]:
    """First and last sample of every rest of a trial, however short. Arguments as `starts_of`."""
    period_s = 1.0 / signals.rate_hz
    cycles = max(1, int(np.ceil(COUNTS * count / (slow * period_s))))
    if len(position) <= 2 * cycles:
        return []
    least = max(TRAVEL_COUNTS * count, TRAVEL_S * slow)
    return _rests(_resting(position, cycles, slow * period_s), position, least)


def _resting(position: FloatArray, cycles: int, slow_step: float) -> BoolArray:
    """Samples up to which the joint was slow, over the cycles before each."""
    moved = np.abs(position[cycles:] - position[:-cycles])
    slow: BoolArray = np.concatenate([np.zeros(cycles, dtype=bool), moved <= slow_step * cycles])
    slow[:cycles] = slow[cycles]
    return slow


def _rests(resting: BoolArray, position: FloatArray, least: float) -> list[tuple[int, int]]:
    """First and last sample of each rest; what travels less than `least` between two of them is creep of one."""
    edges = np.diff(np.concatenate([[0], resting.astype(np.int8), [0]]))
    found: list[tuple[int, int]] = []
    for begin, end in zip(np.flatnonzero(edges == 1).tolist(), (np.flatnonzero(edges == -1) - 1).tolist(), strict=True):
        if found and np.abs(position[found[-1][1] : begin + 1] - position[found[-1][1]]).max() < least:
            found[-1] = found[-1][0], end
        else:
            found.append((begin, end))
    return found


def _start(signals: Signals, begin: int, end: int, direction: float, turns_back: bool) -> Start | None:
    line = _line(signals, begin, end)
    if line is None:
        return None
    effort, deviation, slope, count = line
    jump = _jump(signals, end, count, direction)
    if jump is not None:
        effort, deviation = jump
    rest_s = (end - begin) / signals.rate_hz
    return Start(end, direction, effort, deviation, direction * slope, rest_s, turns_back)


def _line(signals: Signals, begin: int, end: int) -> tuple[float, float, float, int] | None:
    """Effort at the end of a rest, its standard deviation, and its slope; over the longest window without a bend.

    Beside them how many samples the window has.
    """
    found = None
    for window_s in WINDOWS_S:
        count = round(window_s * signals.rate_hz) + 1
        if count < FEWEST_SAMPLES + 1:
            continue
        first = end - count + 1
        if first < begin:
            break
        effort = signals.effort[first : end + 1]
        if not np.isfinite(effort).all():
            break
        time_s = (np.arange(count) - (count - 1)) / signals.rate_hz
        columns = np.column_stack([np.ones(count), time_s, time_s**2])
        if found is not None and _bends(columns, effort):
            break
        plain = columns[:, :2]
        coefficients = np.linalg.lstsq(plain, effort, rcond=None)[0]
        rest = effort - plain @ coefficients
        variance = float(rest @ rest) / (count - 2)
        deviation = float(np.sqrt(variance * np.linalg.inv(plain.T @ plain)[0, 0]))
        found = float(coefficients[0]), deviation, float(coefficients[1]), count
    return found


def _jump(signals: Signals, end: int, count: int, direction: float) -> tuple[float, float] | None:
    """Effort and its standard deviation where it jumps along the motion, as a servo makes it; None where it does not.

    The last sample at rest and the first in motion are held against the line through those before. It let go somewhere
    between.
    """
    before, after = signals.effort[end - count + 1 : end], signals.effort[end : end + 2]
    columns = np.column_stack([np.ones(len(before)), np.arange(-len(before), 0)])
    coefficients = np.linalg.lstsq(columns, before, rcond=None)[0]
    rest = before - columns @ coefficients
    free = len(before) - 2
    ahead = np.column_stack([np.ones(len(after)), np.arange(len(after))])
    spread = 1.0 + np.einsum("ij,jk,ik->i", ahead, np.linalg.inv(columns.T @ columns), ahead)
    way = direction * (after - ahead @ coefficients)
    beyond = -stdtrit(free, JUMPED / len(after))  # of Student's t, without the cost of scipy.stats
    jumps = way > beyond * np.sqrt(float(rest @ rest) / free * spread)
    if not jumps.any():
        return None
    most = float(way[jumps].max())
    return float(coefficients[0]) + 0.5 * direction * most, most / np.sqrt(12.0)  # uniform on the way


def _bends(columns: FloatArray, effort: FloatArray) -> bool:
    coefficients = np.linalg.lstsq(columns, effort, rcond=None)[0]
    rest = effort - columns @ coefficients
    variance = float(rest @ rest) / (len(effort) - 3)
    deviation = np.sqrt(variance * np.linalg.inv(columns.T @ columns)[2, 2])
    return bool(abs(coefficients[2]) > CURVED * deviation)


def resolution_of(positions: Sequence[FloatArray]) -> float:
    """The smallest step of position that trials show; median over the trials."""
    steps = []
    for position in positions:
        step = np.abs(np.diff(position))
        span = float(np.ptp(position))
        real = step[step > 1e-9 * span]
        if len(real):
            steps.append(float(real.min()))
    return float(np.median(steps)) if steps else 0.0
