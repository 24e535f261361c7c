"""General Kinetic Friction from steady points of a balanced joint (paper, sections 2.2, 3.2.1, Figs 2, 3).

    I = sgn(w) (Fc + (Fs - Fc) exp(-|w/vs|^ds) + b |w|)                 (2)
        + offset + rise_offset exp(-|w/vs|^ds) [+ J dw/dt]

Robust bounded regression: soft-L1 loss, its scale from the median absolute residual. The offset is what differs between
the directions (an arm not quite balanced, a current sensor's zero, unequal Coulomb friction); in one direction alone it
could not be told from Coulomb friction. Dry friction that is a share larger one way is larger by that share of its rise
towards rest, too: the offset of the rise. Neither is part of the curve.

J, in A s2/rad, is for points whose speed is not quite steady: within a finite travel a heavy arm is not. What little it
still gains is worth J dw/dt, and without it that share is taken for friction. No part of the curve either.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from compensator.errors import CalibrationError
from compensator.line_fit import Interval, t_quantile
from compensator.motion.curve_regression import Solution, solve
from compensator.motion.kinetic_friction import FloatArray, KineticFriction

POINTS = {True: 10, False: 6}  # with the Stribeck shape (6 parameters) and without (3): a few more than parameters
SPEEDS = {True: 5, False: 2}  # different speeds, whichever the direction: parameters that depend on speed
POINTS_PER_DIRECTION = 2
LOW_SHARE = 0.1  # of the highest speed: at least that low has one to go to see static friction
NOT_TOLD = "not determined: static friction is not told from Coulomb friction"
NOT_COVERED = "below the lowest speed measured: extrapolated"
AT_BOUND = "held by its physical bound"


def check_points(speed_rad_s: ArrayLike, current_a: ArrayLike, stribeck: bool = True) -> tuple[FloatArray, FloatArray]:
    """The points as arrays of shape (n,).

    Raises:
        CalibrationError: naming what is wrong, with values and units, and what would help.
    """
    speed, current = np.asarray(speed_rad_s, dtype=np.float64), np.asarray(current_a, dtype=np.float64)
    if speed.shape != current.shape or speed.ndim != 1:
        raise CalibrationError(
            f"speeds have shape {speed.shape} and currents {current.shape}; allowed is one current for each speed"
        )
    for name, values, unit in (("speed", speed, "rad/s"), ("current", current, "A")):
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            raise CalibrationError(
                f"{name} of point {wrong[0]} is {values[wrong[0]]} {unit}; allowed is a finite number"
            )
    _check_count(speed, POINTS[stribeck])
    _check_motion(speed)
    _check_speeds(np.abs(speed), stribeck)
    return speed, current


def check_accelerations(acceleration_rad_s2: ArrayLike, speed: FloatArray) -> FloatArray:
    """The accelerations as an array of the speeds' shape.

    Raises:
        CalibrationError: another shape, or one is not finite.
    """
    acceleration = np.asarray(acceleration_rad_s2, dtype=np.float64)
    if acceleration.shape != speed.shape:
        raise CalibrationError(
            f"accelerations have shape {acceleration.shape} and speeds {speed.shape}; allowed is one for each speed"
        )
    wrong = np.flatnonzero(~np.isfinite(acceleration))
    if len(wrong):
        raise CalibrationError(
            f"acceleration of point {wrong[0]} is {acceleration[wrong[0]]} rad/s2; allowed is a finite number"
        )
    return acceleration


def _check_count(speed: FloatArray, least: int) -> None:
    if len(speed) < least:
        raise CalibrationError(
            f"there are {len(speed)} points; allowed is at least {least}. Measure more steady speeds"
        )


def _check_motion(speed: FloatArray) -> None:
    resting = np.flatnonzero(speed == 0.0)
    if len(resting):
        raise CalibrationError(
            f"speed of point {resting[0]} is 0 rad/s; allowed is any other: a joint at rest does not show its sliding "
            "friction. Leave stalled points out"
        )
    for name, count in (("forward", int(np.sum(speed > 0.0))), ("backward", int(np.sum(speed < 0.0)))):
        if count < POINTS_PER_DIRECTION:
            raise CalibrationError(
                f"there are {count} points moving {name}; allowed is at least {POINTS_PER_DIRECTION}: in one direction "
                "alone, Coulomb friction and an offset of the current are one and the same. Measure both directions"
            )


def _check_speeds(magnitude: FloatArray, stribeck: bool) -> None:
    slowest, fastest = float(np.min(magnitude)), float(np.max(magnitude))
    different = 1 + int(np.sum(np.diff(np.sort(magnitude)) > 0.01 * fastest * LOW_SHARE))
    if different < SPEEDS[stribeck]:
        raise CalibrationError(
            f"there are {different} different speeds; allowed is at least {SPEEDS[stribeck]}. Measure at more speeds"
        )
    if stribeck and slowest > LOW_SHARE * fastest:
        raise CalibrationError(
            f"the lowest speed is {slowest:.4g} rad/s; allowed is at most {LOW_SHARE * fastest:.4g} rad/s, a tenth of "
            "the highest: static friction and the Stribeck speed show at low speed only. Measure at lower speeds, or "
            "fit Coulomb and viscous friction alone (stribeck=False)"
        )


@dataclass(frozen=True, slots=True)
class FrictionFit:
    """One friction curve and how sure it is.

    Attributes:
        curve: eq. (2).
        parameters: 95 % interval of each of its parameters, of `offset_a`, with `stribeck` of `rise_offset_a` and,
            where accelerations were given, of `inertia_a_s2_rad`, by name.
        scatter_a: standard deviation of the points about the curve, outliers aside [A].
        points: number of them.
        covariance: of Fc, Fs - Fc [A], ln vs, ln ds and b, shape (5, 5); 0 for what was not fitted or lies at a bound.
    """

    curve: KineticFriction
    parameters: dict[str, Interval]
    scatter_a: float
    points: int
    covariance: FloatArray

    def half_width_a(self, speed_rad_s: ArrayLike) -> FloatArray:
        """Half of the 95 % interval of the curve at speeds, shape (n,) [A]: how well it is known there."""
        speed, curve = np.abs(np.asarray(speed_rad_s, dtype=np.float64)), self.curve
        power = np.minimum((speed / curve.stribeck_speed_rad_s) ** curve.shape, 700.0)
        bump = np.exp(-power)
        steep = (curve.static_a - curve.coulomb_a) * bump * power * curve.shape
        slope = -steep * np.log(speed / curve.stribeck_speed_rad_s)
        gradient = np.column_stack([np.ones_like(speed), bump, steep, slope, speed])
        variance = np.sum((gradient @ self.covariance) * gradient, axis=1)
        return np.asarray(t_quantile(max(self.points - len(self.covariance), 1)) * np.sqrt(variance))


NO_PART_OF_THE_CURVE = ("offset_a", "inertia_a_s2_rad", "rise_offset_a")


def fit(
    speed_rad_s: ArrayLike,
    current_a: ArrayLike,
    stribeck: bool = True,
    acceleration_rad_s2: ArrayLike | None = None,
) -> FrictionFit:
    """Fit one curve to the steady points of one load.

    Args:
        speed_rad_s: steady speeds, shape (n,), both signs, none 0; of the motor shaft if a look-up is to give duties.
        current_a: motor current at each, shape (n,).
        stribeck: False leaves out static friction and the Stribeck shape (Fs = Fc): for points without low speeds.
        acceleration_rad_s2: of the same shaft, shape (n,), where the speeds are not quite steady. Sign as the speed's
            where the joint gains speed.

    Raises:
        CalibrationError: too few points, not finite, at rest, one direction only, or (with `stribeck`) no low speeds.
    """
    speed, current = check_points(speed_rad_s, current_a, stribeck)
    acceleration = None if acceleration_rad_s2 is None else check_accelerations(acceleration_rad_s2, speed)
    solution = solve(speed, current, stribeck, acceleration)
    quantile = t_quantile(len(speed) - solution.fitted)
    parameters = _intervals(solution, quantile, float(np.min(np.abs(speed))))
    curve = KineticFriction(**{name: one.value for name, one in parameters.items() if name not in NO_PART_OF_THE_CURVE})
    return FrictionFit(curve, parameters, solution.scatter_a, len(speed), solution.covariance[:5, :5])


def _intervals(solution: Solution, quantile: float, slowest_rad_s: float) -> dict[str, Interval]:
    """Intervals of the parameters by name, in the order of `KineticFriction`, the offset last."""
    coulomb_a, rise_a, log_speed, log_shape, viscous, offset_a, inertia, rise_offset_a = solution.p
    width = quantile * np.sqrt(np.diag(solution.covariance))
    static_width = quantile * np.sqrt(np.sum(solution.covariance[:2, :2]))
    told = bool(solution.free[1]) and rise_a > width[1]
    found = {
        "coulomb_a": _linear(coulomb_a, width[0], solution.free[0]),
        "static_a": _linear(coulomb_a + rise_a, static_width, True)
        if told
        else Interval(float(coulomb_a + rise_a), note=NOT_TOLD),
        "stribeck_speed_rad_s": _logarithmic(log_speed, width[2], solution.free[2], told, slowest_rad_s),
        "shape": _logarithmic(log_shape, width[3], solution.free[3], told),
        "viscous_a_s_rad": _linear(viscous, width[4], solution.free[4]),
        "offset_a": _around(offset_a, width[5]),
        "rise_offset_a": _around(rise_offset_a, width[7]) if told else Interval(0.0, note=NOT_TOLD),
    }
    return found | ({"inertia_a_s2_rad": _linear(inertia, width[6], True)} if solution.free[6] else {})


def _around(value: float, width: float) -> Interval:
    return Interval(float(value), float(value - width), float(value + width))


def _linear(value: float, width: float, free: bool) -> Interval:
    """Of a parameter that is never below 0."""
    if not free:
        return Interval(float(value), note=AT_BOUND)
    return Interval(float(value), max(float(value - width), 0.0), float(value + width))


def _logarithmic(log_value: float, width: float, free: bool, told: bool, lowest: float = 0.0) -> Interval:
    """Of a parameter that is fitted by its logarithm, since its errors are ratios."""
    value = float(np.exp(log_value))
    if not told:
        return Interval(value, note=NOT_TOLD)
    if not free:
        return Interval(value, note=AT_BOUND)
    note = NOT_COVERED if value < lowest else ""
    return Interval(value, float(np.exp(log_value - width)), float(np.exp(log_value + width)), note)
