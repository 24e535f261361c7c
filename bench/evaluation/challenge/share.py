"""The share of the effort that a hidden mechanism changes: the same joint with it and without it."""

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import uniform_filter1d

from bench.evaluation.challenge.answer import Truth
from compensator.lab.model.held_out_error import LEAST_OF_EFFORT
from compensator.lab.recordings.recording import FloatArray, Recording

SMOOTHED_S = 0.1  # slower than most of what stick and slip do, never at the same moment twice
KIND = "excitation"  # moves alike in all, set point for set point


def effort_share(with_it: Sequence[Recording], without: Sequence[Recording], again: Sequence[Recording]) -> float:
    """RMS of what the mechanism changes in the motor current over the current's own RMS, over all motions.

    Two runs also differ by stick-slip and noise. The power of that difference is subtracted.

    Args:
        with_it: trials of the joint as it is.
        without: the same trials, the same randomness, the mechanism left out.
        again: as `without`, with other randomness.
    """
    change = _power_of_difference(with_it, without) - _power_of_difference(without, again)
    whole = np.concatenate([_motion(one) for one in with_it if one.kind == KIND])
    return float(np.sqrt(max(change, 0.0) / np.mean(whole**2)))


def remarks_on(truths: Sequence[Truth]) -> list[str]:
    """One sentence for each mechanism of which its recordings hold next to nothing: to miss it is no fault."""
    return [
        f"{truth.title}: these recordings hold next to nothing of it, less than {LEAST_OF_EFFORT:.2%} of the effort; "
        "no model of them could show it."
        for truth in truths
        if truth.share < LEAST_OF_EFFORT
    ]


def _power_of_difference(one: Sequence[Recording], other: Sequence[Recording]) -> float:
    pairs = [(_motion(a), _motion(b)) for a, b in zip(one, other, strict=True) if a.kind == KIND]
    rows = [min(len(a), len(b)) for a, b in pairs]
    changed = [a[-count:] - b[-count:] for (a, b), count in zip(pairs, rows, strict=True)]
    return float(np.mean(np.concatenate(changed) ** 2))


def _motion(recording: Recording) -> FloatArray:
    """The smoothed current while the set point moves: to settle before and after takes as long as it takes."""
    name = "current_a" if "current_a" in recording.channels else "current_estimate_a"
    current = recording.channels[name]
    targets = np.nan_to_num(recording.channels["target_rad"])
    last = int(np.flatnonzero(targets)[-1]) + 1
    window = max(1, round(SMOOTHED_S / float(np.median(np.diff(recording.channels["time_s"])))))
    rests = np.flatnonzero(targets[:last] == 0.0)
    first = int(rests[-1]) + 1 if len(rests) else 0
    smoothed: FloatArray = uniform_filter1d(current, window)[first:last]
    return smoothed
