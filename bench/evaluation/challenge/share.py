"""The share of the effort that a hidden mechanism changes: the same joint with it and without it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter1d

from bench.evaluation.challenge.answer import Truth
from compensator.lab.model.held_out_error import LEAST_OF_EFFORT
from compensator.lab.recordings.recording import FloatArray, Recording

SMOOTHED_S = 0.1  # slower than most of what stick and slip do, never at the same moment twice
KIND = "excitation"  # moves alike in all, set point for set point
MEANING = (
    "Share of the effort: rms of what the mechanism changes in the motor current of the motions, over the rms of that "
    "current; what two runs of one joint differ by anyway is taken off."
)


class Share(NamedTuple):
    """What a mechanism makes of the effort, 0..1.

    Attributes:
        value: without what two runs of one joint differ by anyway.
        at_most: with it.
    """

    value: float
    at_most: float


def effort_share(with_it: Sequence[Recording], without: Sequence[Recording], again: Sequence[Recording]) -> Share:
    """RMS of what the mechanism changes in the motor current over the current's own RMS, over all motions.

    Two runs also differ by stick-slip and noise. The power of that difference is subtracted. What is below it is not
    told so: a model, which averages over all rows, may show it all the same.

    Args:
        with_it: trials of the joint as it is.
        without: the same trials, the same randomness, the mechanism left out.
        again: as `without`, with other randomness.
    """
    differs = _power_of_difference(with_it, without)
    change = differs - _power_of_difference(without, again)
    whole = np.mean(np.concatenate([_motion(one) for one in with_it if one.kind == KIND]) ** 2)
    return Share(float(np.sqrt(max(change, 0.0) / whole)), float(np.sqrt(differs / whole)))


def faint(truths: Sequence[Truth]) -> list[str]:
    """Names of those of which the recordings surely hold less than a diagnosis may name: to miss them is no fault."""
    return [truth.name for truth in truths if _is_faint(truth)]


def share_in_words(truth: Truth) -> str:
    """The share of the effort, as per cent; its bound, where it is too small to be told from the scatter of runs."""
    if truth.share >= LEAST_OF_EFFORT:
        return f"{100 * truth.share:.2f} %"
    return "not told" if truth.share_at_most is None else f"at most {_percent(truth.share_at_most)}"


def remarks_on(truths: Sequence[Truth]) -> list[str]:
    """One sentence for each mechanism whose share is nothing, or is not told from the scatter of runs."""
    return [_remark(truth) for truth in truths if truth.share < LEAST_OF_EFFORT]


def _remark(truth: Truth) -> str:
    if _is_faint(truth):
        return (
            f"{truth.title}: these recordings hold next to nothing of it, {share_in_words(truth)} of the effort; "
            f"a diagnosis names nothing under {_percent(LEAST_OF_EFFORT)}, so that to miss it does not count."
        )
    bound = "" if truth.share_at_most is None else f" ({share_in_words(truth)} of the effort)"
    return (
        f"{truth.title}: with it and without it the motor current differs by no more than two runs of one joint do"
        f"{bound}, so that its share is not told; a model, which averages over all rows, may show it all the same."
    )


def _is_faint(truth: Truth) -> bool:
    return truth.share_at_most is not None and truth.share_at_most < LEAST_OF_EFFORT


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"


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
