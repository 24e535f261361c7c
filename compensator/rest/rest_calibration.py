"""What eqs (9), (10) leave in the load, found once on known loads: asymmetry, gear loss, scatter; and taken out again.

Let F be the friction of the joint at rest without a moment on it, growing with the weight W on its axis, and L the
current of the load. Then the two currents of breakaway have mean and half difference

    M = a L + c sgn(L) + r F        eq. (9) would have M = L
    D = F + b |L| + e [L != 0]      eq. (10) would have D = F whatever the angle
    F = f0 + f1 W

D is what the breakaways show less what the ramps gained: k r^(2/3), k = k0 + k1 [L != 0] + k2 |L| of all searches
together, since one alone tells it badly. It grows with the inertia J that is set in motion, with the arm's where the
teeth touch: k = q J^(1/3) (`breakaway_fit`). Where J is known, one unknown q tells k far better than three, and with it
b and e.

r: friction is (1 + r) F forwards, (1 - r) F backwards. a, b, c: gear loss (`gear_loss`); the teeth lose b L on average,
(a - 1) L more in driving than in being driven, and pass on c of the friction behind them. e: friction behind the teeth,
which does not show where they are free. L = 0 shows r and F alone; another angle under the same loads shows the rest.

With free play the arm's own friction e holds any load below e by itself: the teeth are free, the motor lets go alone,
and M = r F whatever the load. The least that teeth in touch can show is M = a e + c + r F. So what is seen tells either
that the load lies within -e .. e, or how large it is beyond.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign, hypot, nan, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from compensator.errors import CalibrationError
from compensator.line_fit import Interval, t_quantile
from compensator.motion.gear_loss import GearLoss
from compensator.rest.breakaway_fit import BreakawayFit

BAND = 1.959964
FLOOR_A = 1e-6  # least scatter, where a joint shows none
LEAST_POINTS = 6
UNKNOWNS = 3  # of a fit at two rates
UNLIKELY = 1e-4  # that a search scatters so much by chance
# a free arm may carry any load up to what its friction holds, all equally likely; 0.96 of that, and free teeth ruled
# out wrongly 1 time in 100, make 95 %
SPREAD = 0.96
RULED_OUT = 2.575829


class RestPoint(NamedTuple):
    """One search under a known load.

    Attributes:
        load_current_a: L, by weight, lever, gear ratio and torque constant [A]; 0 where the load hangs straight down.
        load_kg: W.
        found: M and D, with their scatter.
        inertia_kg_m2: that a breakaway sets in motion, at the joint; NaN where it is not known.
    """

    load_current_a: float
    load_kg: float
    found: BreakawayFit
    inertia_kg_m2: float = nan


class RestEstimate(NamedTuple):
    """Load and friction of a joint at rest.

    Attributes:
        load_current_a: I_load [A] with its 95 % interval.
        friction_current_a: F [A], what eq. (10) would give without a moment; selects the friction curve.
    """

    load_current_a: Interval
    friction_current_a: Interval


@dataclass(frozen=True, slots=True)
class RestCalibration:
    """What known loads told.

    Attributes:
        gain, step_a, asymmetry: a, c, r.
        covariance: of the three, in that order; rows of A, A, 1.
        slope, offset_a, offset_sd_a: b, e and the standard deviation of e.
        delay: k0, k1, k2.
        floor_a, scatter, moment_scatter: standard deviation of one breakaway: sqrt(floor^2 + (scatter F)^2 +
            (moment_scatter D)^2). What the teeth lose may scatter with friction or not.
    """

    gain: float = 1.0
    step_a: float = 0.0
    asymmetry: float = 0.0
    covariance: tuple[tuple[float, ...], ...] = ((0.0,) * 3,) * 3
    slope: float = 0.0
    offset_a: float = 0.0
    offset_sd_a: float = 0.0
    delay: tuple[float, ...] = (0.0, 0.0, 0.0)
    floor_a: float = FLOOR_A
    scatter: float = 0.0
    moment_scatter: float = 0.0

    def gear_loss(self) -> GearLoss:
        """The same loss as it acts on a joint in motion, never below 0."""
        more = self.gain - 1.0
        driving, back_driving = max(self.slope + more, 0.0), min(max(self.slope - more, 0.0), 0.99)
        return GearLoss(driving, back_driving, (driving + back_driving) * self.friction_behind_a)

    @property
    def friction_behind_a(self) -> float:
        """f [A], friction behind the teeth, 0 or more: e tells it, and c / b does; each by how sure it is."""
        told = [(self.offset_a, self.offset_sd_a)]
        if self.slope > 0.0:
            told.append((self.step_a / self.slope, sqrt(self.covariance[1][1]) / self.slope))
        weights = [1.0 / max(sd_a, FLOOR_A) ** 2 for _, sd_a in told]
        return max(sum(w * f_a for w, (f_a, _) in zip(weights, told, strict=True)) / sum(weights), 0.0)

    def scatter_a(self, friction_a: float, half_a: float) -> float:
        """Standard deviation of one breakaway [A], by F and D."""
        return hypot(self.floor_a, self.scatter * friction_a, self.moment_scatter * half_a)

    def estimate(self, found: BreakawayFit) -> RestEstimate:
        """Load and friction from the breakaways of one search."""
        free_a = found.load_current_a.value - self.asymmetry * found.friction_current_a.value
        # either constant tells of the friction behind the teeth, and each is told badly: the larger counts
        touches = 1.0 if abs(free_a) > max(self._least_a / 2.0, 2.0 * self.step_a) else 0.0
        half_a = self._half_a(found, touches, abs(free_a))
        load_a = self._load_a(found.load_current_a.value, half_a) if touches else 0.0
        friction_a = max(half_a - self.slope * abs(load_a) - self.offset_a * touches, 0.0)
        # as many one way as the other: mean and half difference are equally sure
        noise_a = self._noise_a(found, self.scatter_a(friction_a, half_a)) / sqrt(found.breakaways)
        friction_width_a = BAND * sqrt(1.0 + self.slope**2) * noise_a
        return RestEstimate(
            self._load(found, load_a, friction_a, noise_a),
            Interval(friction_a, friction_a - friction_width_a, friction_a + friction_width_a),
        )

    @staticmethod
    def _noise_a(found: BreakawayFit, known_a: float) -> float:
        """Scatter of one breakaway [A]: the calibrated one, unless this search itself scatters by far more.

        Then this is not what was calibrated - a disturbance, another gear - and the search's own scatter counts, with
        the t quantile of so few in place of the normal one.
        """
        from scipy.special import chdtri  # imported when needed: every command starts with this file

        freedom = found.breakaways - UNKNOWNS
        if freedom < 1 or not found.scatter_a**2 * freedom > known_a**2 * chdtri(freedom, UNLIKELY):
            return known_a
        return found.scatter_a * t_quantile(freedom) / BAND

    @property
    def _least_a(self) -> float:
        """The least that eq. (9) shows of teeth that carry a load, asymmetry aside [A]."""
        return self.gain * self._held_a + abs(self.step_a)

    @property
    def _held_a(self) -> float:
        """The load that the arm's own friction holds [A]."""
        return max(self.offset_a, 0.0)

    def _load(self, found: BreakawayFit, load_a: float, friction_a: float, noise_a: float) -> Interval:
        """I_load with every load that the search does not contradict: of teeth in touch, of free ones, or of both."""
        mean_a = found.load_current_a.value
        free_a = mean_a - self.asymmetry * found.friction_current_a.value
        unseen_a, ends_a = self._width_a(0.0, friction_a, noise_a), [load_a]
        touching_a = self._load_a(mean_a, self._half_a(found, 1.0, abs(free_a)))
        width_a = self._width_a(touching_a, friction_a, noise_a) / self._per_load(copysign(1.0, touching_a))
        free = load_a == 0.0 or abs(free_a) <= RULED_OUT / BAND * unseen_a
        touch = abs(touching_a) + width_a >= self._held_a
        # too much for free teeth, and too little for teeth in touch: either may be what the noise hides
        unclear = not free and not touch
        if free or unclear:
            half_a = max(SPREAD * hypot(self._held_a, BAND * self.offset_sd_a), unseen_a / self._per_load(0.0))
            ends_a += [-half_a, half_a]
        if touch or unclear:
            ends_a += [touching_a - width_a, touching_a + width_a]
        return Interval(load_a, min(ends_a), max(ends_a))

    def _width_a(self, load_a: float, friction_a: float, noise_a: float) -> float:
        """Half of the 95 % interval of M under a load, by the scatter of breakaways and by what was calibrated."""
        gradient = np.array([load_a, float(np.sign(load_a)), friction_a])
        known_a2 = float(gradient @ np.array(self.covariance) @ gradient)
        known_a2 += (self.asymmetry * self.offset_sd_a) ** 2
        return BAND * sqrt((1.0 + self.asymmetry**2) * noise_a**2 + known_a2)

    def _half_a(self, found: BreakawayFit, touches: float, load_a: float) -> float:
        """D: what the ramps gained taken off."""
        k0, k1, k2 = self.delay
        return found.ramped_a - (k0 + k1 * touches + k2 * load_a) * found.ramp

    def _load_a(self, mean_a: float, half_a: float) -> float:
        """L from M and D, where the teeth touch."""
        way = copysign(1.0, mean_a - self.asymmetry * half_a)
        left_a = mean_a - way * self.step_a - self.asymmetry * (half_a - self.offset_a)
        return left_a / self._per_load(way)

    def _per_load(self, way: float) -> float:
        """What M less r D grows by with the load on a side; with neither side given, on average."""
        return self.gain - self.asymmetry * self.slope * way


def calibrate(points: Sequence[RestPoint]) -> RestCalibration:
    """From searches at angle 0 and at another angle, each under two loads or more.

    Raises:
        CalibrationError: too few points, or no angle with (or without) a moment, or one load only.
    """
    _check(points)
    load_a, weight_kg = _column(points, "load_current_a"), _column(points, "load_kg")
    found = [point.found for point in points]
    ones, touches = np.ones_like(load_a), (load_a != 0.0).astype(float)
    ramped_a, ramp = _column(found, "ramped_a"), _column(found, "ramp")
    counts = np.sqrt(_column(found, "breakaways"))
    delays, columns = [ones, touches, np.abs(load_a)], [ones, weight_kg, np.abs(load_a), touches]

    def ramps_off_a(weights: NDArray[np.float64]) -> tuple[list[float], NDArray[np.float64]]:
        told = _column(found, "delay")
        known = _by_inertia(_column(points, "inertia_kg_m2"), told, weights)
        delay, _ = _fit(delays, told if known is None else known, weights)
        gained = np.column_stack(delays) @ delay if known is None else known
        return delay, ramped_a - gained * ramp

    # once with equal weights, for what the scatter goes with
    _, half_a = ramps_off_a(counts)
    (f0, f1, _, _), _ = _fit(columns, half_a, counts)
    friction_a = np.maximum(f0 + f1 * weight_kg, 0.0)
    floor_a, scatter, moment_scatter = _scatter(found, friction_a, half_a)
    weights = counts / np.sqrt(floor_a**2 + (scatter * friction_a) ** 2 + (moment_scatter * half_a) ** 2)
    delay, half_a = ramps_off_a(weights)
    (f0, f1, slope, offset_a), told = _fit(columns, half_a, weights)
    mean_a = np.array([one.load_current_a.value for one in found])
    (gain, step_a, asymmetry), covariance = _fit([load_a, np.sign(load_a), f0 + f1 * weight_kg], mean_a, weights)
    known = tuple(map(tuple, covariance.tolist()))
    offset_sd_a = sqrt(float(told[3, 3]))
    return RestCalibration(
        gain, step_a, asymmetry, known, slope, offset_a, offset_sd_a, tuple(delay), floor_a, scatter, moment_scatter
    )


def _by_inertia(
    inertia_kg_m2: NDArray[np.float64], delay: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """k of each search, by the inertia that it sets in motion; None where that is not known."""
    if not np.all(inertia_kg_m2 > 0.0):
        return None
    root = np.cbrt(inertia_kg_m2)
    return np.asarray(root * np.sum(weights**2 * root * delay) / np.sum((weights * root) ** 2))


def _column(items: Sequence[RestPoint] | Sequence[BreakawayFit], name: str) -> NDArray[np.float64]:
    return np.array([getattr(item, name) for item in items], dtype=np.float64)


def _fit(
    columns: list[NDArray[np.float64]], values: NDArray[np.float64], weights: NDArray[np.float64]
) -> tuple[list[float], NDArray[np.float64]]:
    matrix = np.column_stack(columns) * weights[:, None]
    if np.linalg.matrix_rank(matrix) < len(columns):
        raise CalibrationError(
            "the searches do not tell gear loss from asymmetry; allowed are two loads or more, hanging straight down "
            "and at another angle such as 1.57 rad. Run a load sweep over more loads"
        )
    solution: list[float] = np.linalg.lstsq(matrix, values * weights, rcond=None)[0].tolist()
    covariance = np.asarray(np.linalg.inv(matrix.T @ matrix), dtype=np.float64)
    return solution, covariance


def _scatter(
    found: Sequence[BreakawayFit], friction_a: NDArray[np.float64], half_a: NDArray[np.float64]
) -> tuple[float, float, float]:
    """Floor, and shares of F and D, of the scatter of a breakaway, from that within each search."""
    from scipy.optimize import nnls  # imported when needed: every command starts with this file

    variance = np.array([one.scatter_a**2 for one in found])
    scale = np.mean(variance) or FLOOR_A**2
    # a variance is as uncertain as it is large: weighed by where the first fit puts it
    columns = np.column_stack([np.ones_like(variance), friction_a**2, half_a**2])
    weights = np.ones_like(variance)
    for _ in range(5):
        solution = nnls(columns * weights[:, None] / scale, variance * weights / scale)[0]
        weights = scale / np.maximum(columns @ solution, 0.01 * scale)
    return max(sqrt(solution[0]), FLOOR_A), sqrt(solution[1]), sqrt(solution[2])


def _check(points: Sequence[RestPoint]) -> None:
    straight = {point.load_kg for point in points if point.load_current_a == 0.0}
    aside = {point.load_kg for point in points if point.load_current_a != 0.0}
    if len(points) < LEAST_POINTS or len(straight) < 2 or len(aside) < 2:
        raise CalibrationError(
            f"{len(points)} searches, with {len(straight)} loads straight down and {len(aside)} aside; allowed are "
            f"{LEAST_POINTS} or more, two loads or more each. Run a load sweep over more loads and angles"
        )
