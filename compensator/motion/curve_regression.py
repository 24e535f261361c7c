"""The regression behind a friction curve: bounded, robust, with the covariance of what it found.

Robust: soft-L1 loss of residuals over a scale, and the scale is the spread of the bulk of them. Covariance: that of an
M-estimator (Huber, Ann. Statist. 1 (1973), 799) whose residuals do not all scatter alike (HC3 of MacKinnon and White,
J. Econometrics 29 (1985), 305): at creeping speed a window averages over little of the path, and scatters more.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from compensator.motion.kinetic_friction import FloatArray

if TYPE_CHECKING:  # imported when needed: every command starts with this file, and scipy's optimizers take a while
    from scipy.optimize import OptimizeResult

SHAPES = (0.3, 4.0)  # allowed ds; the literature has 0.5 .. 2
STARTS = tuple((share, shape) for share in (0.005, 0.02, 0.06, 0.2) for shape in (1.0, 2.0))
SCALE_PASSES = 5
SOFTNESS = 2.0  # scale of the loss over the spread: 95 % as efficient as least squares where there are no outliers
MOST_LEVERAGE = 0.9  # of one point, in the covariance: beyond, its own residual tells nothing
PLAIN = (0, 4, 5)  # parameters without the Stribeck shape
RISE_OFFSET = 7
WHOLE = (0, 1, 2, 3, 4, 5, RISE_OFFSET)
INERTIA = 6  # fitted where accelerations are known
COUNT = 8


class Solution(NamedTuple):
    """What was found.

    Attributes:
        p: Fc, Fs - Fc [A], ln vs [ln rad/s], ln ds, b [A s/rad], offset [A], inertia [A s2/rad], offset
            of the rise [A].
        covariance: of p, shape (8, 8); 0 for what was not fitted or lies at a bound.
        free: shape (8,); whether it was fitted and lies within its bounds.
        scatter_a: standard deviation of the bulk of the residuals.
        fitted: number of parameters that were fitted.
    """

    p: FloatArray
    covariance: FloatArray
    free: NDArray[np.bool_]
    scatter_a: float
    fitted: int


class _Problem:
    """Residuals of eq. (2) and their derivatives, as functions of the parameters that are fitted."""

    def __init__(self, speed: FloatArray, current: FloatArray, acceleration: FloatArray, stribeck: bool) -> None:
        self.magnitude, self.direction, self.current = np.abs(speed), np.sign(speed), current
        self.acceleration, quickest = acceleration, float(np.max(np.abs(acceleration)))
        self.fastest, self.largest = float(np.max(self.magnitude)), float(np.max(np.abs(current)))
        self.fitted = np.array(sorted([*(WHOLE if stribeck else PLAIN), *((INERTIA,) if quickest > 0.0 else ())]))
        per_speed, per_acceleration = self.largest / self.fastest, self.largest / (quickest or 1.0)
        self.scales = np.array(
            [self.largest, self.largest, 1.0, 1.0, per_speed, self.largest, per_acceleration, self.largest]
        )
        self.low = np.array([0.0, 0.0, np.log(1e-3 * self.fastest), np.log(SHAPES[0]), 0.0, -np.inf, 0.0, -np.inf])
        self.high = np.array([np.inf, np.inf, np.log(self.fastest), np.log(SHAPES[1]), np.inf, np.inf, np.inf, np.inf])

    def start(self, speed_share: float, shape: float) -> FloatArray:
        speed, viscous = np.log(speed_share * self.fastest), 0.3 * self.largest / self.fastest
        rise = 0.2 * self.largest if 1 in self.fitted else 0.0
        return np.array([0.5 * self.largest, rise, speed, np.log(shape), viscous, 0.0, 0.0, 0.0])

    def whole(self, fitted: FloatArray) -> FloatArray:
        """All parameters, fitted or not."""
        p = self.start(1.0, 2.0)
        p[self.fitted] = fitted
        return p

    def residuals(self, fitted: FloatArray) -> FloatArray:
        p = self.whole(fitted)
        bump = np.exp(-self._power(p))
        friction = self.direction * (p[0] + p[1] * bump + p[4] * self.magnitude) + p[5] + p[RISE_OFFSET] * bump
        return np.asarray(friction + p[INERTIA] * self.acceleration - self.current)

    def derivatives(self, fitted: FloatArray) -> FloatArray:
        p = self.whole(fitted)
        power = self._power(p)
        bump, shape = np.exp(-power), np.exp(p[3])
        ones, rise = np.ones_like(power), self.direction * p[1] + p[RISE_OFFSET]
        steep = rise * bump * power * shape
        curve = [self.direction, self.direction * bump, steep, -steep * (np.log(self.magnitude) - p[2])]
        others = [self.direction * self.magnitude, ones, self.acceleration, bump]
        return np.column_stack([*curve, *others])[:, self.fitted]

    def _power(self, p: FloatArray) -> FloatArray:
        # beyond 700 the exponential is 0 in any case, and the power times it has to be 0, too
        return np.asarray(np.minimum(np.exp(np.exp(p[3]) * (np.log(self.magnitude) - p[2])), 700.0))


def solve(speed: FloatArray, current: FloatArray, stribeck: bool, acceleration: FloatArray | None = None) -> Solution:
    """Fit eq. (2), an offset and, where the points still accelerate, an inertia to checked points, shapes (n,)."""
    problem = _Problem(speed, current, np.zeros_like(speed) if acceleration is None else acceleration, stribeck)
    starts = [problem.start(*start) for start in (STARTS if stribeck else STARTS[:1])]
    scale_a = 0.02 * problem.largest
    best = min((_run(problem, start[problem.fitted], scale_a) for start in starts), key=lambda found: found.cost)
    for _ in range(SCALE_PASSES):
        spread_a = max(_spread(best.fun, len(problem.fitted)), 1e-7 * problem.largest)
        scale_a = SOFTNESS * spread_a
        best = _run(problem, best.x, scale_a)
    p = problem.whole(best.x)
    inside = np.minimum(p - problem.low, problem.high - p) > 1e-6 * problem.scales
    free = np.isin(np.arange(COUNT), problem.fitted) & inside
    return Solution(p, _covariance(problem, best, free, scale_a), free, spread_a, len(problem.fitted))


def _run(problem: _Problem, start: FloatArray, scale_a: float) -> "OptimizeResult":
    from scipy.optimize import least_squares

    low, high = problem.low[problem.fitted], problem.high[problem.fitted]
    return least_squares(
        problem.residuals,
        np.clip(start, low, high),
        problem.derivatives,
        bounds=(low, high),
        x_scale=problem.scales[problem.fitted],
        loss="soft_l1",
        f_scale=scale_a,
    )


def _spread(residual_a: FloatArray, parameters: int) -> float:
    """Standard deviation of the bulk, from the median absolute residual, for the parameters that were fitted."""
    count = len(residual_a)
    return float(1.4826 * np.median(np.abs(residual_a)) * np.sqrt(count / (count - parameters)))


def _covariance(problem: _Problem, best: "OptimizeResult", free: NDArray[np.bool_], scale_a: float) -> FloatArray:
    columns = problem.derivatives(best.x)[:, free[problem.fitted]]
    bend = 1.0 + (best.fun / scale_a) ** 2
    influence_a, slope = best.fun / np.sqrt(bend), bend**-1.5
    # pinv: with the Stribeck rise at 0 its speed and shape move nothing
    bread = np.linalg.pinv(columns.T @ (slope[:, None] * columns), rcond=1e-14, hermitian=True)
    leverage = np.clip(np.sum((columns @ bread) * columns, axis=1) * slope, 0.0, MOST_LEVERAGE)
    swayed = columns * (influence_a / (1.0 - leverage))[:, None]
    covariance = np.zeros((COUNT, COUNT))
    covariance[np.ix_(free, free)] = bread @ (swayed.T @ swayed) @ bread
    return covariance
