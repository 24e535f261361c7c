"""The size from which an effect is found nine times in ten, from items of all sizes."""

from collections.abc import Sequence
from math import nan

import numpy as np
from scipy.special import expit

from compensator.lab.recordings.recording import BoolArray, FloatArray

FEWEST = 20  # items that a threshold is fitted to
RESAMPLES = 400
NINE_IN_TEN = np.log(9.0)  # log odds
# Every curve that is asked for: sizes by 2 %, rises from hardly any to a step, shares that are found whatever they are.
SIZES = np.exp(np.arange(np.log(0.05), np.log(20.0), 0.02))
SLOPES = np.geomspace(0.5, 100.0, 20)
GUESSED = np.array([0.0, 0.01, 0.03, 0.1, 0.2])


def smallest_found(ratios: Sequence[float], found: Sequence[bool]) -> tuple[float, float, float]:
    """The size that is found nine times in ten: a logistic curve in its logarithm, the likeliest of a grid.

    Some are found whatever their size, by chance or by another effect: the curve begins at a guessed share.

    Args:
        ratios: of each item, its size over some unit, all above zero.
        found: whether it was.

    Returns:
        The size in the same unit, and its 95 % interval from items drawn again (Efron 1979); NaN where there are fewer
        than 20 items, or all are found, or none.
    """
    answers = np.asarray(found, dtype=bool)
    if len(answers) < FEWEST or answers.all() or not answers.any():
        return nan, nan, nan
    generator = np.random.default_rng(0)
    drawn = generator.multinomial(len(answers), np.full(len(answers), 1.0 / len(answers)), size=RESAMPLES)
    counts = np.vstack([np.ones(len(answers)), drawn])
    best = np.full((len(SIZES), len(counts)), -np.inf)
    for slope in SLOPES:
        middle = np.log(SIZES) - NINE_IN_TEN / slope
        rise = expit(slope * (np.log(ratios) - middle[:, None]))
        for guessed in GUESSED:
            best = np.maximum(best, _log_likelihood(rise, answers, guessed) @ counts.T)
    sizes = SIZES[np.argmax(best, axis=0)]
    low, high = np.quantile(sizes[1:], [0.025, 0.975])
    return float(sizes[0]), float(low), float(high)


def _log_likelihood(rise: FloatArray, found: BoolArray, guessed: float) -> FloatArray:
    """Of each item at each threshold of the grid, where the curve without the guessed share is at `rise`."""
    chance = guessed + (1.0 - guessed) * rise
    likelihood: FloatArray = np.log(np.clip(np.where(found, chance, 1.0 - chance), 1e-9, None))
    return likelihood
