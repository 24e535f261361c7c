"""A position that stands still while the joint moves on: a sensor that is stuck, which looks like friction or cogging.

Friction and end stops hold a joint, too, and the position does not change either. Two things tell the sensor: the
drive's speed goes on, by more than a filter that makes it late would have it fade away, or the position comes back in
one leap. A joint that breaks away may leap between two samples, too, and stands again after it (stick-slip); one that
went on unseen was under way before, or still is.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.gaps import LONGEST_GAP_PERIODS, typical_step_s
from compensator.lab.recordings.recording import FloatArray, Recording

SHORTEST_S = 0.1  # less is a sample or two that were lost and filled up with the last one
FEWEST_SAMPLES = 10
LATE_S = 0.1  # by which the drive's speed may lag behind its position, or precede it
LAG_WINDOW_S = 0.1  # over which ways are compared to find a filter's time constant
MOST_LAG_S = 1.0  # of a filter
LEAST_EXPLAINED = 0.5  # of what position and speed differ by: a filter explains as much, or there is none
MISSED = 10.0  # times the step that 19 in 20 samples in motion stay below: what the speed covers meanwhile
LEAP = 10.0  # times the step that 19 in 20 samples in motion stay below
ALONE = 3.0  # times the steps after it: a joint that starts goes on
AFTER = 3  # steps that are looked at after a leap
UNDER_WAY = 0.5  # of the mean speed that a leap hides: so fast goes the joint before, or after it
LEAST_SHARE = (
    0.1  # of the speed that 19 in 20 samples in motion stay below: less may be where the drive's speed has its zero
)


def stuck_positions(recordings: Sequence[Recording], facts: Facts) -> list[str]:
    """One sentence, of all trials in which it shows: where it does, and what to do."""
    unit = facts.position_unit
    found = [(one.name, next(_stuck(one, unit), None)) for one in recordings]
    stuck = [(name, span) for name, span in found if span is not None]
    if not stuck:
        return []
    name, (start_s, end_s, why) = stuck[0]
    others = f" (and so in {', '.join(repr(other) for other, _ in stuck[1:])})" if stuck[1:] else ""
    return [
        f"trial '{name}': position_{unit} stands still from {start_s:.4g} to {end_s:.4g} s, though {why}: the sensor "
        f"is stuck{others}; leave the trial out, or leave position_{unit} empty there and import again"
    ]


def _stuck(recording: Recording, unit: str) -> Iterator[tuple[float, float, str]]:
    """Start [s], end [s] and sign of each stretch in which the sensor is stuck."""
    channels = recording.channels
    time_s, position = channels["time_s"], channels.get(f"position_{unit}")
    if position is None:
        return
    speed = channels.get(f"velocity_{unit}_s")
    step, period_s = np.diff(position), np.diff(time_s)
    longest_s = LONGEST_GAP_PERIODS * typical_step_s(time_s) if len(period_s) else 0.0
    gap = ~(period_s <= longest_s)
    moving = np.abs(step[(step != 0.0) & np.isfinite(step) & ~gap])
    if not len(moving):
        return
    typical = float(np.quantile(moving, 0.95))
    for first, last in _standing(step, gap):
        if last - first < FEWEST_SAMPLES or time_s[last] - time_s[first] < SHORTEST_S:
            continue
        missed, fast = (0.0, 0.0) if speed is None else _covered(time_s, position, speed, slice(first, last + 1))
        if missed > MISSED * typical and fast > LEAST_SHARE * typical / float(np.median(period_s)):
            yield time_s[first], time_s[last], f"velocity_{unit}_s covers {missed:.3g} {unit} meanwhile"
        elif last < len(step) and not gap[last] and _is_leap(step[last:], typical) and _goes_on(position, first, last):
            yield time_s[first], time_s[last], f"it goes on with a leap of {step[last]:.3g} {unit}"


def _standing(step: FloatArray, gap: "np.ndarray[tuple[int], np.dtype[np.bool_]]") -> Iterator[tuple[int, int]]:
    """First and last sample of each stretch of one and the same position without a gap."""
    same = np.concatenate([[False], (step == 0.0) & ~gap, [False]]).astype(np.int8)
    change = np.diff(same)
    for first, last in zip(np.flatnonzero(change == 1), np.flatnonzero(change == -1), strict=True):
        yield int(first), int(last)


def _covered(time_s: FloatArray, position: FloatArray, speed: FloatArray, standing: slice) -> tuple[float, float]:
    """How far the speed goes one way and how fast, less what it may be late by at either end, and fade away in."""
    lag_s = _lag_s(time_s, position, speed, standing)
    time_s, speed = time_s[standing], speed[standing]
    within = (time_s >= time_s[0] + LATE_S) & (time_s <= time_s[-1] - LATE_S) & np.isfinite(speed)
    if int(within.sum()) < 2:
        return 0.0, 0.0
    time_s, speed = time_s[within], speed[within]
    way = np.append(0.0, _way(time_s, speed)) + lag_s * (speed - speed[0])
    return float(np.ptp(way)), float(np.quantile(np.abs(speed), 0.95))


def _lag_s(time_s: FloatArray, position: FloatArray, speed: FloatArray, standing: slice) -> float:
    """Time constant of a first-order filter that the speed went through [s]; 0 where it shows none.

    Through such a filter q' = v + lag v', and over a window the way is that of the speed and lag times its change.
    The stretch in question is left out: there the position may be wrong.
    """
    known = np.isfinite(time_s) & np.isfinite(position) & np.isfinite(speed)
    known[standing] = False
    if int(known.sum()) < FEWEST_SAMPLES:
        return 0.0
    time_s, position, speed = time_s[known], position[known], speed[known]
    hop = max(1, round(LAG_WINDOW_S / max(float(np.median(np.diff(time_s))), np.finfo(float).tiny)))
    ends = np.arange(0, len(time_s), hop)
    whole = np.diff(time_s[ends]) < 2.0 * LAG_WINDOW_S  # none across what is left out
    way = np.append(0.0, _way(time_s, speed))
    differs = (np.diff(position[ends]) - np.diff(way[ends]))[whole]
    change = np.diff(speed[ends])[whole]
    if not np.any(change):
        return 0.0
    lag_s = float(np.clip(change @ differs / (change @ change), 0.0, MOST_LAG_S))
    explained = 1.0 - float(np.sum((differs - lag_s * change) ** 2)) / max(float(differs @ differs), 1e-300)
    return lag_s if explained >= LEAST_EXPLAINED else 0.0


def _way(time_s: FloatArray, speed: FloatArray) -> FloatArray:
    """The way so far after each step, by trapezoids, shape (n - 1,)."""
    way: FloatArray = np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time_s))
    return way


def _is_leap(step: FloatArray, typical: float) -> bool:
    """Whether the first step is far larger than any motion's, and stands alone."""
    leap, after = float(abs(step[0])), np.abs(step[1 : 1 + AFTER])
    return leap > LEAP * typical and leap > ALONE * float(np.nanmax(after, initial=0.0))


def _goes_on(position: FloatArray, first: int, last: int) -> bool:
    """Whether the joint is under way before it seems to stand, or after the leap: half as long, the same way."""
    half = (last - first) // 2
    leap = position[last + 1] - position[last]
    before = position[first] - position[max(first - half, 0)]
    after = position[min(last + 1 + half, len(position) - 1)] - position[last + 1]
    return any(bool(way / leap >= UNDER_WAY * half / (last - first)) for way in (before, after))
