"""Rows per independent row, where friction is another one in each stretch."""

import numpy as np

from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import IntArray

MOST_HELD = 0.9  # of an effect's power in one stretch, beyond which the others tell nothing of that one's scatter


def rows_per_independent_row(own: FloatArray, left: FloatArray, stretch: IntArray) -> float:
    """From how an effect's share of what is left differs between stretches.

    What neighbouring rows have in common does not see slow scatter: friction that is another one each time, a mean that
    drifts. Sums over whole stretches do (Liang, Zeger 1986). A stretch that holds much of an effect has drawn its size
    to itself and leaves little of its own scatter: each is judged by the size that the others give (jackknife: Bell,
    McCaffrey 2002).

    Args:
        own: what the effect adds to the effort beyond the model, as fitted, weighted, shape (n,).
        left: weighted residual with the effect in the model, shape (n,).
        stretch: of each row, shape (n,).

    Returns:
        Variance of the fitted size over that which independent rows would give; 1 where the effect adds nothing.
    """
    _, labels = np.unique(stretch, return_inverse=True)
    sums, powers = np.bincount(labels, weights=own * left), np.bincount(labels, weights=own**2)
    expected = float(np.mean(left**2) * powers.sum())
    if expected == 0.0:
        return 1.0
    alone = sums / (1.0 - np.minimum(powers / powers.sum(), MOST_HELD))
    return float(np.sum(alone**2)) / expected
