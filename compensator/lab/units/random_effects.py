"""One quantity of several units by a random-effects model: value_i ~ N(common, scatter^2 + error_i^2).

The scatter is that of Paule and Mandel (1982), which for equal errors is the restricted-likelihood one; the interval of
the common value is Hartung and Knapp's (2001), that of the scatter Viechtbauer's Q-profile (2007). With few units all
of them are wide, as they have to be: Student's t with the degrees of freedom that so many units leave.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import chdtri, fdtrc, stdtrit

from compensator.lab.recordings.recording import BoolArray, FloatArray

CONFIDENCE = 0.95
UPPER = 0.5 + 0.5 * CONFIDENCE
LEAST_ERROR = 1e-9  # of the largest value: an error of 0 would outweigh everything


@dataclass(frozen=True)
class UnitValues:
    """One quantity of k units.

    Attributes:
        value: shape (k,).
        error: standard error of each value within its unit, shape (k,).
        freedom: degrees of freedom of each error, shape (k,).
    """

    value: FloatArray
    error: FloatArray
    freedom: FloatArray

    @property
    def variance(self) -> FloatArray:
        """Squared errors, none of them 0; shape (k,)."""
        least = LEAST_ERROR * float(np.abs(self.value).max(initial=0.0)) or np.sqrt(np.finfo(float).tiny)
        variance: FloatArray = np.maximum(self.error, least) ** 2
        return variance

    def of(self, chosen: BoolArray) -> "UnitValues":
        """Some of the units."""
        return UnitValues(self.value[chosen], self.error[chosen], self.freedom[chosen])


@dataclass(frozen=True, slots=True)
class Common:
    """What k units have in common, in the quantity's unit; intervals hold with 95 %.

    Attributes:
        units: k.
        value, low, high: mean of the kind.
        scatter, scatter_low, scatter_high: standard deviation of the units' true values.
        next_low, next_high: where the value of one more unit is expected that is measured as these are.
    """

    units: int
    value: float
    low: float
    high: float
    scatter: float
    scatter_low: float
    scatter_high: float
    next_low: float
    next_high: float


def common_of(found: UnitValues) -> Common:
    """Mean and scatter of at least two units."""
    count = len(found.value)
    scatter2 = scatter_squared(found, count - 1.0)
    mean, variance = weighted_mean(found, scatter2)
    quantile = float(stdtrit(count - 1.0, UPPER))
    half = quantile * np.sqrt(variance)
    # the scatter alone is often taken for 0 where errors are as large; with them, as measured, it is not
    reach = quantile * np.sqrt(variance + scatter2 + float(np.mean(found.variance)))
    # chdtri gives the quantile by the chance above it
    low2, high2 = (scatter_squared(found, float(chdtri(count - 1.0, above))) for above in (1.0 - UPPER, UPPER))
    return Common(
        count,
        mean,
        mean - half,
        mean + half,
        float(np.sqrt(scatter2)),
        float(np.sqrt(low2)),
        float(np.sqrt(high2)),
        mean - reach,
        mean + reach,
    )


def scatter_squared(found: UnitValues, wanted: float) -> float:
    """The variance between units at which the weighted sum of squares is as wanted; 0 where it never is so large."""
    value, variance = found.value, found.variance
    if _sum_of_squares(value, variance, 0.0) <= wanted:
        return 0.0
    high = float(np.var(value))
    while _sum_of_squares(value, variance, high) > wanted:
        high *= 2.0
    return float(brentq(lambda scatter2: _sum_of_squares(value, variance, scatter2) - wanted, 0.0, high, rtol=1e-10))


def weighted_mean(found: UnitValues, scatter2: float) -> tuple[float, float]:
    """Mean of the units for a variance between them, and the mean's own variance."""
    weight = 1.0 / (scatter2 + found.variance)
    return float(weight @ found.value / weight.sum()), float(1.0 / weight.sum())


def chance_of_one_value(found: UnitValues) -> float:
    """Chance that units of one and the same true value differ as these do.

    Welch's test (1951): unlike Cochran's Q it knows that each error was estimated from a few trials.
    """
    count = len(found.value)
    weight = 1.0 / found.variance
    share = weight / weight.sum()
    doubt = float(np.sum((1.0 - share) ** 2 / found.freedom)) / (count**2 - 1.0)
    between = _sum_of_squares(found.value, found.variance, 0.0) / (count - 1.0)
    return float(fdtrc(count - 1.0, 1.0 / (3.0 * doubt), between / (1.0 + 2.0 * (count - 2.0) * doubt)))


def _sum_of_squares(value: FloatArray, variance: FloatArray, scatter2: float) -> float:
    """Of the values about their weighted mean, weighted."""
    weight = 1.0 / (scatter2 + variance)
    off = value - weight @ value / weight.sum()
    return float(weight @ (off * off))
