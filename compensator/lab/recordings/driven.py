"""Stretches in which something else turns the joint: the motor gives exactly nothing, and friction does not slow it.

A measured effort that is exactly 0 for seconds comes from a power stage that is off. A joint that coasts then loses
speed to friction. One that does not is driven from outside, by a hand, a load machine or another joint, and its rows
say nothing of what the motor has to overcome.
"""

import numpy as np

from compensator.lab.recordings.recording import BoolArray, FloatArray

SHORTEST_S = 5.0  # of a stretch: in less, a well-oiled flywheel loses next to nothing
BLOCK_S = 0.5  # over which speed is averaged: noise does not hide that it falls
KEPT = 0.99  # of the highest speed of a stretch's first half, that its second half must reach
MOVING = 0.05  # of the speed that 19 in 20 samples stay below: less is no motion


def driven_from_outside(time_s: FloatArray, position: FloatArray, effort: FloatArray) -> BoolArray:
    """Samples of such stretches, shape (n,).

    Args:
        time_s: rising, shape (n,).
        position: of the joint, shape (n,).
        effort: as measured, shape (n,).
    """
    found = np.zeros(len(time_s), dtype=bool)
    nothing = effort == 0.0
    if not nothing.any():
        return found
    usual = float(np.nanquantile(np.abs(np.diff(position) / np.diff(time_s)), 0.95)) if len(time_s) > 1 else 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], nothing, [False]]).astype(np.int8)))
    for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if time_s[end - 1] - time_s[start] >= SHORTEST_S and _is_driven(time_s[start:end], position[start:end], usual):
            found[start:end] = True
    return found


def _is_driven(time_s: FloatArray, position: FloatArray, usual: float) -> bool:
    """Whether the joint moves, and is no slower in the second half than in the first."""
    marks = np.arange(time_s[0], time_s[-1], BLOCK_S)
    known = np.isfinite(position)
    if known.sum() < 2:
        return False
    speed = np.abs(np.diff(np.interp(marks, time_s[known], position[known]))) / BLOCK_S
    half = len(speed) // 2
    first, second = float(speed[:half].max(initial=0.0)), float(speed[half:].max(initial=0.0))
    return first > MOVING * usual > 0.0 and second >= KEPT * first
