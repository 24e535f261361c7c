"""Whether steady points can carry a friction curve, said before any curve is fitted."""

import numpy as np
from numpy.typing import ArrayLike

from compensator.errors import CalibrationError
from compensator.motion.kinetic_friction import FloatArray

POINTS = {True: 10, False: 6}  # with the Stribeck shape (6 parameters) and without (3): a few more than parameters
SPEEDS = {True: 5, False: 2}  # different speeds, whichever the direction: parameters that depend on speed
POINTS_PER_DIRECTION = 2
LOW_SHARE = 0.1  # of the highest speed: at least that low has one to go to see static friction


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
