"""How fast the effort changes where it goes by the place of the joint: ripple of slow, steady turning.

Slow motion has hardly any bandwidth, and a filter that is chosen by the motion alone takes the ripple away that such
motion is recorded for. At steady speed, what comes again at the same place in every pass is no noise. An order counts
where its mean over the passes stands out of their scatter, and where it is a part of the effort that matters.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import f as f_distribution

from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.recording import FloatArray, Recording

PLACES = 256  # of a pass
FEWEST_PASSES = 4  # of one direction
STEADY = 0.25  # standard deviation of the speed of a pass, over its mean
WHOLE = 0.98  # of the period, that a pass covers
CHANCE = 1e-4  # of an order that is none
MATTERS = 0.01  # of the effort's power
STROKE_BLOCKS = 400  # of a trial, whose mean positions tell its strokes
BACK = 0.05  # of the period: a way back that ends a stroke
SPEED_PLACES = 16  # of a pass, between which its speed is taken
TURN_RAD = 2.0 * np.pi


@dataclass(frozen=True, slots=True)
class Pass:
    """One way through the whole period in one direction. Attributes: effort over the place, shape (PLACES,); speed."""

    effort: FloatArray
    speed: float


def place_locked_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> float:
    """The highest frequency at which the effort repeats with the place of the joint [Hz]; 0 where it does not."""
    name = f"position_{facts.position_unit}"
    there = [one for one in recordings if name in one.channels and np.isfinite(one.channels[name]).any()]
    if not there:
        return 0.0
    low = min(float(np.nanmin(one.channels[name])) for one in there)
    high = max(float(np.nanmax(one.channels[name])) for one in there)
    period = TURN_RAD if facts.joint == "rotary" and high - low >= TURN_RAD else high - low
    if not period > 0.0:
        return 0.0
    found = [0.0]
    for direction in (1.0, -1.0):
        passes = [p for one in there for p in _passes(one, name, effort, low, period, direction)]
        if len(passes) >= FEWEST_PASSES:
            speed = float(np.median([one.speed for one in passes]))
            found.append(_highest_order(passes) * speed / period)
    return max(found)


def _highest_order(passes: Sequence[Pass]) -> int:
    """The highest order, of cycles per period, that comes again in all passes; 0 where none does."""
    efforts = np.array([one.effort - one.effort.mean() for one in passes])
    orders = np.fft.rfft(efforts, axis=1)[:, 1 : PLACES // 4] / PLACES
    mean = orders.mean(axis=0)
    scatter = np.mean(np.abs(orders - mean) ** 2, axis=0) / (len(passes) - 1)
    ratio = np.abs(mean) ** 2 / np.maximum(scatter, np.finfo(float).tiny)
    sure = ratio > f_distribution.isf(CHANCE, 2, 2 * (len(passes) - 1))
    matters = 2.0 * np.abs(mean) ** 2 > MATTERS * float(np.mean(efforts**2))
    found = np.flatnonzero(sure & matters)
    return int(found[-1]) + 1 if len(found) else 0


def _passes(
    recording: Recording, name: str, effort: Effort, low: float, period: float, direction: float
) -> Iterator[Pass]:
    """The steady passes of one trial, one period after the other, of every stroke in one direction."""
    time_s, position, measured = recording.channels["time_s"], recording.channels[name], effort.of(recording)
    known = np.isfinite(position) & np.isfinite(measured)
    time_s, position, measured = time_s[known], position[known], measured[known]
    for stroke in _strokes(position, direction, BACK * period):
        # a joint that trembles passes each place once
        way = np.maximum.accumulate(direction * (position[stroke] - low))
        for start in way[0] + period * np.arange(max(1, int((way[-1] - way[0]) / period))):
            inside = (way >= start) & (way < start + period)
            if inside.sum() < PLACES // 2 or np.ptp(way[inside]) < WHOLE * period:
                continue
            at = np.interp(start + period * np.linspace(0.0, WHOLE, SPEED_PLACES), way[inside], time_s[stroke][inside])
            steps = np.diff(at)
            if (steps <= 0.0).any() or np.std(1.0 / steps) > STEADY * np.mean(1.0 / steps):
                continue
            speed = WHOLE * period / float(at[-1] - at[0])
            yield Pass(_means(way[inside] / period, measured[stroke][inside]), speed)


def _strokes(position: FloatArray, direction: float, back: float) -> Iterator[slice]:
    """The samples of each stroke in one direction; a way back that is shorter than `back` is trembling."""
    block = max(1, len(position) // STROKE_BLOCKS)
    count = len(position) // block
    way = (direction * position[: count * block]).reshape(count, block).mean(axis=1).tolist()
    lowest = highest = 0
    for index, value in enumerate(way):
        if value > way[highest]:
            highest = index
        if value < way[highest] - back:  # turned back: the stroke ended at its highest
            yield slice(lowest * block, (highest + 1) * block)
            lowest = highest = index
        elif value < way[lowest]:
            lowest = highest = index
    if count:
        yield slice(lowest * block, len(position))


def _means(periods: FloatArray, values: FloatArray) -> FloatArray:
    """Mean of the values at each place of the period; at places that no sample falls into, as at their neighbours."""
    index = np.minimum((periods % 1.0 * PLACES).astype(np.int64), PLACES - 1)
    count = np.bincount(index, minlength=PLACES)
    total = np.bincount(index, weights=values, minlength=PLACES)
    there = np.flatnonzero(count)
    found: FloatArray = np.interp(np.arange(PLACES), there, total[there] / count[there], period=PLACES)
    return found
