"""Which trials are told as repeats of each other, and whether they are: what differs between them counts as scatter."""

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from compensator.lab.recordings.recording import SESSION_START, FloatArray, Recording

REPEAT = "repeat"
NOT_CONDITIONS = (REPEAT, "rows", SESSION_START)  # trials that differ by these alone repeat each other
ALIKE = 0.8  # correlation of two motions from which they can be one
STANDS = 0.02  # rad or m: a position that spreads by less tells of no motion


def repeats(recordings: Sequence[Recording]) -> list[list[int]]:
    """Trials that tell `repeat` and are alike in kind and in every condition but it and their time: two or more each.

    Returns:
        The places of the trials among `recordings`.
    """
    groups: dict[tuple[object, ...], list[int]] = {}
    for index, one in enumerate(recordings):
        if REPEAT in one.conditions:
            held = sorted((key, value) for key, value in one.conditions.items() if key not in NOT_CONDITIONS)
            groups.setdefault((one.kind, *held), []).append(index)
    return [members for members in groups.values() if len(members) > 1]


def unlike_repeats(recordings: Sequence[Recording]) -> Iterator[tuple[Recording, Recording, float]]:
    """Of each group of repeats that do not share a motion, the two that are least alike, and their correlation."""
    for members in repeats(recordings):
        pairs = [(recordings[one], recordings[other]) for one, other in combinations(members, 2)]
        alike = [(found, *pair) for pair in pairs if (found := likeness(*pair)) is not None]
        if alike and (least := min(alike, key=lambda pair: pair[0]))[0] < ALIKE:
            yield least[1], least[2], least[0]


def likeness(one: Recording, other: Recording) -> float | None:
    """Correlation of two motions at equal times, of the set points where both have one; None where nothing moves."""
    for channel in ("target_rad", "target_m", "position_rad", "position_m"):
        if channel in one.channels and channel in other.channels:
            ways = _at_equal_times(one, other, channel)
            if ways.shape[1] > 1 and (np.std(ways, axis=1) > STANDS).all():
                return float(np.corrcoef(*ways)[0, 1])
    return None


def _at_equal_times(one: Recording, other: Recording, channel: str) -> FloatArray:
    """A channel of both, shape (2, n), as long as both last."""
    ways = [_known(recording, channel) for recording in (one, other)]
    if not all(len(time_s) for time_s, _ in ways):
        return np.empty((2, 0))
    time_s = ways[0][0]
    time_s = time_s[time_s <= ways[1][0][-1]]
    return np.array([np.interp(time_s, *way) for way in ways])


def _known(recording: Recording, channel: str) -> tuple[FloatArray, FloatArray]:
    time_s, values = recording.channels["time_s"], recording.channels[channel]
    known = np.isfinite(values)
    return time_s[known] - time_s[0], values[known]
