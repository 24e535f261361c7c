"""Whether a few stretches leave far more than the others: something that comes and goes, whatever the motion.

What is missing from a model comes back with the motion that drives it. A clutch that slips, a tooth that skips or a
cable that catches does not: it leaves most stretches alone, and others not. No column over a driver can hold that.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.left_over.remainder import remainder_of
from compensator.lab.model.weights import bounded_influence
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import BLOCK_S, Dataset

MOST_NAMES = 3

FEWEST_ROWS = 8  # of a stretch, each as far as the model determines its effort
FEWEST_STRETCHES = 10
LARGER = 4.0  # of a stretch's scatter over the median one's; noise gives less than 2, weighted by its motion
MOST = 0.4  # share of the stretches: more are not a few


@dataclass(frozen=True, slots=True)
class Bursts:
    """Stretches of a residual that scatter far more than most.

    Attributes:
        largest: scatter of the worst stretch over the median one's; NaN where there are too few stretches.
        stretches: that scatter LARGER times as much as the median one, and more; of: how many there are.
        trials: indices of their trials.
        of_effort: root mean square of what is left in them over that of the effort in all rows; a few wild rows of a
            stretch count for no more than its others.
    """

    largest: float
    stretches: int
    of: int
    trials: tuple[int, ...]
    of_effort: float = 0.0

    @property
    def are_there(self) -> bool:
        """Whether a few stretches hold what is left."""
        return 0 < self.stretches <= MOST * self.of


def bursts_of(dataset: Dataset, residual: FloatArray, weights: FloatArray, rows: BoolArray) -> Bursts:
    """Look for bursts.

    Args:
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        weights: that bring them to like variance in like motion, shape (rows.sum(),).
        rows: chosen, shape (N,).
    """
    _, stretch = np.unique(dataset.block_index[rows], return_inverse=True)
    power = np.bincount(stretch, weights=(residual * weights) ** 2)
    known = np.bincount(stretch, weights=dataset.steadiness[rows] ** 2)
    enough = known >= FEWEST_ROWS
    scatter = np.sqrt(power / np.bincount(stretch))
    usual = float(np.median(scatter[enough])) if int(enough.sum()) >= FEWEST_STRETCHES else 0.0
    if usual == 0.0:
        return Bursts(float("nan"), 0, int(enough.sum()), ())
    wild = enough & (scatter >= LARGER * usual)
    _, first = np.unique(stretch, return_index=True)
    trials = np.unique(dataset.trial_index[rows][first[wild]])
    left = sum(_power((residual * dataset.steadiness[rows])[stretch == one]) for one in np.flatnonzero(wild))
    effort = dataset.effort[rows]
    of_effort = float(np.sqrt(left / (effort @ effort)))
    largest = float(scatter[enough].max() / usual)
    return Bursts(largest, int(wild.sum()), int(enough.sum()), tuple(map(int, trials)), of_effort)


def _power(residual: FloatArray) -> float:
    """Of a stretch, by its own scatter: in that of all rows, all of a burst would be wild."""
    residual = residual * bounded_influence(residual, np.ones(len(residual)))
    return float(residual @ residual)


def is_rattle(bursts: Bursts, dataset: Dataset, residual: FloatArray, rows: BoolArray) -> bool:
    """Whether what comes in bursts is quicker than any motion, as teeth that bounce are after the sharpest turns.

    Their free play is known, and how a tooth bounces comes again in no trial. What slips or catches pulls for as long
    as it does, which lies in the motion's band.

    Args:
        bursts: that were found.
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        rows: chosen, shape (N,).
    """
    theirs = np.isin(dataset.trial_index, bursts.trials)
    return remainder_of(dataset, residual[theirs[rows]], rows & theirs).denser < 1.0


def some_of(names: Sequence[str]) -> str:
    """The first few of them, and how many more there are."""
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def bursts_in_words(bursts: Bursts, trials: Sequence[str]) -> str:
    """The answer where a few stretches leave far more than the others."""
    return (
        f"No effect of the catalogue is confirmed, yet what is left comes in bursts, "
        f"{bursts.of_effort:.1%} of the effort: {bursts.stretches} of {bursts.of} stretches of "
        f"{BLOCK_S:g} s scatter up to {bursts.largest:.1f} times as much as the others, in {some_of(trials)}. "
        "Something slips, skips, catches or swings there: look at couplings, clutch, cables and the load, and repeat "
        "one of these trials with less load."
    )
