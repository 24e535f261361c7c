"""When a sensor of whole counts shows motion: a threshold with a stated rate of false alarms.

A joint stands at x counts, the sensor reads floor(x + n), n normal with standard deviation sigma. Its place is one such
reading, too. Two of them differ by c counts or more only where their noise differs by more than c - 1, so

    P(false, one reading) <= 2 Q((c - 1) / (sqrt(2) sigma))        Q: upper tail of the normal distribution

With sigma = 0 nothing beyond one count is ever noise. The bound holds for any x; the edge of a count nearly meets it.
"""

from math import erfc, isfinite, sqrt
from statistics import NormalDist

from compensator.errors import ModelParameterError

SECONDS_PER_HOUR = 3600.0
LEAST_COUNTS = 2.0


def threshold_counts(noise_counts: float, false_alarms_per_hour: float, period_s: float) -> float:
    """Counts off its place from which on a joint is said to move.

    Args:
        noise_counts: sigma, noise of one reading before it is cut to counts; 0 or more.
        false_alarms_per_hour: of a joint that stands, and is looked at once per period; above 0.
        period_s: control period [s]; above 0.

    Raises:
        ModelParameterError: an argument outside of what is allowed, or a rate that even silence would exceed.
    """
    if not (isfinite(noise_counts) and noise_counts >= 0.0):
        raise ModelParameterError(f"noise_counts is {noise_counts}; allowed is 0 or more")
    per_reading = false_alarms_per_hour * period_s / SECONDS_PER_HOUR
    if not 0.0 < per_reading < 1.0:
        raise ModelParameterError(
            f"{false_alarms_per_hour:g} false alarms per hour, one reading every {period_s:g} s; allowed is above 0 "
            "and less than one per reading"
        )
    return max(LEAST_COUNTS, 1.0 + sqrt(2.0) * noise_counts * -NormalDist().inv_cdf(per_reading / 2.0))


def false_alarms_per_hour(noise_counts: float, counts: float, period_s: float) -> float:
    """The inverse: the bound on false alarms at a threshold."""
    if noise_counts == 0.0:
        return 0.0 if counts > 1.0 else SECONDS_PER_HOUR / period_s
    return erfc((counts - 1.0) / (2.0 * noise_counts)) * SECONDS_PER_HOUR / period_s
