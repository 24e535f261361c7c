"""I_load and F_load from several breakaways at two ramp rates, with their intervals.

    I = I_load + s (F_load + k r^(2/3))        s = 1 forwards, -1 backwards; r the rate of the ramp [A/s]

That is eqs (9), (10) for one breakaway each way, k = 0. The last term is what the ramp gains before motion is seen: a
body that lets go at t = 0 under a force that grows with r t has travelled r t^3 / (6 m), so it takes (6 m x / r)^(1/3)
to the threshold x, and the current has grown by (6 m x)^(1/3) r^(2/3). Two rates tell k, and with it F_load at rate 0.
Breakaway that depends on the rate by itself is taken up as well, as far as it follows the same power.

As many breakaways one way as the other at each rate: then I_load does not depend on k.
"""

from collections.abc import Sequence
from math import nan, sqrt
from typing import NamedTuple

import numpy as np

from compensator.errors import ModelParameterError
from compensator.line_fit import Interval, t_quantile


class BreakawayEstimate(NamedTuple):
    """What eqs (9) and (10) give.

    Attributes:
        load_current_a: I_load, the current of the load alone [A]; goes to the master.
        friction_current_a: F_load, the friction of the joint under this load [A]; selects the friction curve.
    """

    load_current_a: float
    friction_current_a: float


def estimate(min_current_a: float, max_current_a: float) -> BreakawayEstimate:
    """Eqs (9), (10). Assumes friction equal in both directions.

    Args:
        min_current_a: I_min, at which the joint just moves backwards [A].
        max_current_a: I_max, at which it just moves forwards [A].

    Raises:
        ModelParameterError: I_max is not above I_min, so no friction band lies between them.
    """
    if not max_current_a > min_current_a:
        raise ModelParameterError(
            f"I_max is {max_current_a:.4g} A and I_min {min_current_a:.4g} A; I_max must be above I_min (eqs 9, 10)"
        )
    load = (min_current_a + max_current_a) / 2
    friction = (abs(load - min_current_a) + abs(load - max_current_a)) / 2
    return BreakawayEstimate(load, friction)


DELAY_POWER = 2.0 / 3.0


class Breakaway(NamedTuple):
    """One motion out of rest.

    Attributes:
        direction: 1 or -1.
        current_a: of the motor when the motion was seen, back-EMF left out [A].
        rate_a_s: at which the current was ramped, above 0 [A/s].
        position_rad: where the sensor stood before; NaN where that was not kept.
    """

    direction: float
    current_a: float
    rate_a_s: float
    position_rad: float = nan


class BreakawayFit(NamedTuple):
    """What several breakaways tell.

    Attributes:
        load_current_a: I_load [A], with its 95 % interval.
        friction_current_a: F_load at rate 0 [A], with its interval.
        delay: k; what the ramp gained at a rate is k r^(2/3) [A].
        scatter_a: standard deviation of one breakaway [A].
        breakaways: how many.
        load_variance, friction_variance: of the two currents, as shares of that of one breakaway.
        ramped_a, ramp: half of what lies between the breakaways as they were seen [A], and the mean of r^(2/3) there:
            whoever knows k better takes k times that off.
        position_rad: mean of where the sensor stood; NaN where that was not kept.
    """

    load_current_a: Interval
    friction_current_a: Interval
    delay: float
    scatter_a: float
    breakaways: int
    load_variance: float
    friction_variance: float
    ramped_a: float
    ramp: float
    position_rad: float = nan


def fit(breakaways: Sequence[Breakaway]) -> BreakawayFit:
    """Fit the line; where there is one rate only, without its last term.

    The intervals are by the scatter of these breakaways alone, with a t quantile for how few they are; NaN where there
    are no more of them than unknowns. A calibrated joint knows its scatter better: `rest_calibration`.

    Args:
        breakaways: both directions alike at each rate.

    Raises:
        ModelParameterError: too few, or one direction only.
    """
    rows = np.array([tuple(one) for one in breakaways], dtype=np.float64).reshape(-1, 4)
    direction, current_a, rate, position_rad = rows.T
    columns = np.column_stack([np.ones_like(direction), direction, direction * rate**DELAY_POWER])
    columns = columns if len(set(rate.tolist())) > 1 else columns[:, :2]
    count, unknowns = columns.shape
    if count < unknowns or np.linalg.matrix_rank(columns) < unknowns:
        raise ModelParameterError(f"{count} breakaways; allowed are {unknowns} or more, both ways alike at each rate")
    solution = np.linalg.lstsq(columns, current_a, rcond=None)[0].tolist()
    variances = np.diag(np.linalg.inv(columns.T @ columns)).tolist()
    freedom, scatter_a, quantile = count - unknowns, nan, nan
    if freedom > 0:
        scatter_a = sqrt(float(np.sum((current_a - columns @ solution) ** 2)) / freedom)
        quantile = t_quantile(freedom)
    load, friction = (_interval(solution[place], quantile * scatter_a * sqrt(variances[place])) for place in (0, 1))
    delay = solution[2] if unknowns > 2 else 0.0
    ramped_a = float(np.mean(direction * (current_a - solution[0])))
    ramp = float(np.mean(rate**DELAY_POWER))
    stood_rad = float(np.mean(position_rad))
    return BreakawayFit(load, friction, delay, scatter_a, count, variances[0], variances[1], ramped_a, ramp, stood_rad)


def _interval(value: float, half: float) -> Interval:
    return Interval(value, value - half, value + half)
