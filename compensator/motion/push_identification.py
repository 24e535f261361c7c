"""A joint from a few pushes: inertia, friction and gravity, per motor current, without differentiating a position.

    m dv/dt = i - fc sgn v - fv v - g sin q        (all in A: divided by the torque per current)

Multiplied by a smooth bump that is 0 with its slope at both ends of a window, and integrated by parts twice, the
acceleration becomes the second derivative of the bump times the position (modulating functions: Shinbrot 1957,
"On the analysis of linear and nonlinear systems", Trans. ASME 79).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from compensator.errors import CalibrationError
from compensator.line_fit import Interval, fit_line
from compensator.motion.kinetic_friction import FloatArray

WINDOW_S = 0.12
LEAST_SAMPLES = 8  # in a window
LEAST_WINDOWS = 12
LEAST_SPEED_SHARE = 0.15  # of the fastest; below, friction rises again (Stribeck)


class Motion(NamedTuple):
    """Samples of one motion, shape (n,) each: time [s], angle [rad], motor current towards positive angles [A]."""

    time_s: FloatArray
    position_rad: FloatArray
    current_a: FloatArray


@dataclass(frozen=True, slots=True)
class JointModel:
    """The joint per motor current, with 95 % intervals.

    Attributes:
        inertia_a_s2_rad: current per acceleration of the joint.
        coulomb_a: dry friction.
        viscous_a_s_rad: friction that grows with speed.
        gravity_a: current that holds what is on the arm level.
        windows: pieces of motion that told it.
    """

    inertia_a_s2_rad: Interval
    coulomb_a: Interval
    viscous_a_s_rad: Interval
    gravity_a: Interval
    windows: int


def identify(motions: Sequence[Motion]) -> JointModel:
    """The joint from motions in both directions, driven and coasting.

    Raises:
        CalibrationError: there is too little motion, or it cannot tell the parts from each other.
    """
    windows = [window for motion in motions for window in _windows(motion)]
    if windows:
        fastest = max(abs(speed) for speed, _ in windows)
        windows = [one for one in windows if abs(one[0]) >= LEAST_SPEED_SHARE * fastest]
    if len(windows) < LEAST_WINDOWS:
        raise CalibrationError(
            f"the pushes hold {len(windows)} pieces of {WINDOW_S:g} s in motion; allowed is {LEAST_WINDOWS} or more. "
            "Push farther"
        )
    rows = np.array([row for _, row in windows])
    line = fit_line(rows[:, 1:], rows[:, 0])
    if not line.told or line.values[0] <= 0.0:
        raise CalibrationError(
            f"current and acceleration do not go together ({line.values[0]:.3g} rad/s2 per A): the motions do not tell "
            "inertia from friction. Does the measured current have the sign of the demand?"
        )
    return JointModel(line.inverse(), line.ratio(1), line.ratio(2), line.ratio(3), len(windows))


def _windows(motion: Motion) -> list[tuple[float, FloatArray]]:
    """Mean speed, and the row of equation, of every window in which the joint moves one way all the time."""
    fresh = np.flatnonzero(np.diff(motion.time_s, prepend=-np.inf) > 0.0)
    time_s, position_rad, current_a = (column[fresh] for column in motion)
    found = []
    first = 0
    while first < len(time_s):
        end = int(np.searchsorted(time_s, time_s[first] + WINDOW_S, side="right"))
        if end >= len(time_s):
            break
        steps = np.diff(position_rad[first:end])
        if end - first >= LEAST_SAMPLES and (np.all(steps > 0.0) or np.all(steps < 0.0)):
            found.append(_row(time_s[first:end], position_rad[first:end], current_a[first:end]))
        first += max((end - first) // 4, 1)
    return found


def _row(time_s: FloatArray, position_rad: FloatArray, current_a: FloatArray) -> tuple[float, FloatArray]:
    """Acceleration, current, sign, speed, sin of the angle, each weighted by the bump (1 - u^2)^4 of the window."""
    half_s = (time_s[-1] - time_s[0]) / 2.0
    u = (time_s - time_s[0]) / half_s - 1.0
    rest = 1.0 - u**2
    bump = rest**4
    slope = -8.0 * u * rest**3 / half_s
    bend = (-8.0 * rest**3 + 48.0 * u**2 * rest**2) / half_s**2
    way_rad = position_rad - position_rad[0]  # constants fall out; small numbers round less
    sign = np.sign(position_rad[-1] - position_rad[0])
    # the integral of bump times speed is minus that of slope times position
    columns = (bend * way_rad, bump * current_a, sign * bump, -slope * way_rad, bump * np.sin(position_rad))
    row = np.array([np.trapezoid(column, time_s) for column in columns])
    return float(way_rad[-1] / (time_s[-1] - time_s[0])), row
