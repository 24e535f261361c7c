"""What size an effect may have that trials have hardly shown yet: its physical bounds, and its error.

What few trials say of an effect is an estimate with an error that may be as large as itself, and as often as not beyond
its bounds: drag that would push. A prediction for new trials that takes the estimate for the truth promises what the
joint does not keep. So the coefficients are drawn from all that the rows allow: normal about the estimate, within the
bounds; and it may not be there at all, by the odds of its score (Kass, Raftery 1995). Nor is the noise better known
than so many stretches can tell. What nine in ten of all these cases reach can be promised (assurance: O'Hagan,
Stevens, Campbell 2005).
"""

from collections.abc import Sequence

import numpy as np
from scipy.special import expit
from scipy.stats import chi2, norm, qmc, truncnorm

from compensator.lab.recordings.recording import FloatArray

DRAWS = 64
UNKEPT = 0.1  # share of the cases in which what is promised may not be kept


def possible_sizes(
    found: FloatArray, covariance: FloatArray, ranges: Sequence[tuple[float, float]], draws: int = DRAWS
) -> FloatArray:
    """Coefficients that rows allow an effect, each as likely as the other, shape (draws, k); the same at every call.

    Args:
        found: as fitted freely, shape (k,).
        covariance: of these, shape (k, k).
        ranges: lowest and highest possible value of each.
        draws: how many; even.
    """
    if len(found) == 1:
        return _within(float(found[0]), float(np.sqrt(covariance[0, 0])), *ranges[0], draws)[:, None]
    half = norm.ppf(qmc.Sobol(len(found), scramble=True, rng=0).random(draws // 2))
    values, vectors = np.linalg.eigh(covariance)
    away = half * np.sqrt(np.maximum(values, 0.0)) @ vectors.T
    low, high = np.transpose(ranges)
    drawn: FloatArray = np.clip(np.concatenate([found + away, found - away]), low, high)
    return drawn


def _within(mean: float, deviation: float, low: float, high: float, draws: int) -> FloatArray:
    """Quantiles of a normal distribution within bounds, shape (draws,)."""
    if deviation == 0.0 or not np.isfinite(deviation):
        return np.full(draws, np.clip(mean, low, high))
    levels = (np.arange(draws) + 0.5) / draws
    found = truncnorm.ppf(levels, (low - mean) / deviation, (high - mean) / deviation, mean, deviation)
    # so far beyond a bound that the tail cannot be told from nothing, it lies at the bound
    drawn: FloatArray = np.clip(np.where(np.isfinite(found), found, np.clip(mean, low, high)), low, high)
    return drawn


def chance_of(score: float) -> float:
    """That an effect is there at all, as likely as not beforehand, by its score in units of 2 ln L."""
    return float(expit(0.5 * score))


def promised(evidence: FloatArray, chance: float, stretches: int) -> float:
    """Evidence that nine in ten of all cases reach.

    Args:
        evidence: of each possible size, if the effect is there, over the noise as it seems; none is negative.
        chance: that it is; if it is not, there is none.
        stretches: that the noise is known from: their mean power over the true one is chi-squared over its freedom.
    """
    absent = 1.0 - chance
    if absent >= UNKEPT:
        return 0.0
    noise = chi2.ppf((np.arange(DRAWS) + 0.5) / DRAWS, stretches) / stretches
    return float(np.quantile(np.outer(evidence, noise), (UNKEPT - absent) / chance))
