"""Gains of the position servo from the joint's inertia and the delays of its loop, with the margins that they leave.

The open loop is

    L(s) = exp(-s T) (kp + ki / s + kd s / (1 + s tau)) / (s (m s + fv))

m inertia and fv viscous friction per motor current, T delay, tau lag of the measured speed. kp = m w^2, kd = 2 z m w
place the poles (Astrom, Hagglund, "PID Controllers", 1995, section 4.4), and of all w, z and ki that leave every load
the margins which the same book asks for (section 4.3: phase 30 to 60 degrees, gain 2 to 5), those with the largest ki
are taken: what is left of an error that friction holds goes with 1 / ki (Astrom, Panagopoulos, Hagglund 1998, "Design
of PI controllers based on non-convex optimization", Automatica 34).
"""

from dataclasses import dataclass
from itertools import product
from math import degrees, inf

import numpy as np

from compensator.errors import CalibrationError

DAMPINGS = (0.7, 0.85, 1.0, 1.2, 1.4, 1.7)
INTEGRAL_SHARES = (0.1, 0.14, 0.2, 0.28)  # of w: ki = kp w share, slow beside the poles
LEAST_PHASE_DEG, LEAST_GAIN = 32.0, 2.0
LEAST_GAIN_FREE = 1.05  # of the motor alone, while it crosses the free play
FASTEST_RAD_S, SLOWEST_RAD_S = 30.0, 2.0
_OMEGA = np.geomspace(0.05, 2000.0, 1200)
_BANDWIDTHS = np.geomspace(FASTEST_RAD_S, SLOWEST_RAD_S, 30)


@dataclass(frozen=True, slots=True)
class Loop:
    """What the servo closes its loop around.

    Attributes:
        inertias_a_s2_rad: current per acceleration of the joint, of each load that it is to carry.
        free_inertia_a_s2_rad: that of the motor alone, without the arm; the least that the loop meets.
        viscous_a_s_rad: friction that grows with speed.
        delay_s: from a measured position to the current that answers it, the hold of a cycle included.
        velocity_lag_s: time constant of the measured speed.
    """

    inertias_a_s2_rad: tuple[float, ...]
    free_inertia_a_s2_rad: float
    viscous_a_s_rad: float
    delay_s: float
    velocity_lag_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Gains:
    """Gains of a PID servo: position in, motor current out."""

    proportional_a_rad: float
    integral_a_rad_s: float
    derivative_a_s_rad: float


@dataclass(frozen=True, slots=True)
class Margins:
    """How far a loop is from swinging.

    Attributes:
        phase_deg: at the highest frequency at which the loop's gain is 1.
        gain: by which the loop's gain may grow.
    """

    phase_deg: float
    gain: float


@dataclass(frozen=True, slots=True)
class ServoDesign:
    """Gains, and what they leave.

    Attributes:
        gains: of the servo.
        bandwidth_rad_s: w.
        margins: of each load.
        free_gain: gain margin of the motor alone.
    """

    gains: Gains
    bandwidth_rad_s: float
    margins: tuple[Margins, ...]
    free_gain: float


def design(loop: Loop) -> ServoDesign:
    """The gains with the largest integral gain among those that leave the margins.

    Raises:
        CalibrationError: not even the slowest do.
    """
    poles = product(_BANDWIDTHS.tolist(), DAMPINGS, INTEGRAL_SHARES)
    placed = [(_placed(w, damping, share, loop), w) for w, damping, share in poles]
    # the first that leaves the margins is the one: what is behind it need not be looked at
    for gains, w in sorted(placed, key=lambda one: -one[0].integral_a_rad_s):
        found = _checked(gains, w, loop)
        if found is not None:
            return found
    raise CalibrationError(
        f"with a delay of {loop.delay_s:.3g} s and a lag of {loop.velocity_lag_s:.3g} s no servo leaves margins of "
        f"{LEAST_PHASE_DEG:g} degrees and {LEAST_GAIN:g} at {SLOWEST_RAD_S:g} rad/s; shorten the control period"
    )


def _checked(gains: Gains, bandwidth_rad_s: float, loop: Loop) -> ServoDesign | None:
    """The design of these gains; None where a margin is missing."""
    found = []
    for inertia in loop.inertias_a_s2_rad:
        found.append(margins(gains, inertia, loop))
        if found[-1].phase_deg < LEAST_PHASE_DEG or found[-1].gain < LEAST_GAIN:
            return None
    free_gain = margins(gains, loop.free_inertia_a_s2_rad, loop).gain
    return ServoDesign(gains, bandwidth_rad_s, tuple(found), free_gain) if free_gain >= LEAST_GAIN_FREE else None


def margins(gains: Gains, inertia_a_s2_rad: float, loop: Loop) -> Margins:
    """Phase and gain margin with a load."""
    s = 1j * _OMEGA
    servo = gains.proportional_a_rad + gains.integral_a_rad_s / s
    servo = servo + gains.derivative_a_s_rad * s / (1.0 + s * loop.velocity_lag_s)
    response = np.exp(-s * loop.delay_s) * servo / (s * (inertia_a_s2_rad * s + loop.viscous_a_s_rad))
    size, phase_rad = np.abs(response), np.unwrap(np.angle(response))
    # the phase begins near -180 or -270 degrees; count it from there
    phase_rad += 2.0 * np.pi * np.round((-1.25 * np.pi - phase_rad[0]) / (2.0 * np.pi))
    crossing = np.flatnonzero((size[:-1] >= 1.0) & (size[1:] < 1.0))
    if not len(crossing):
        return Margins(0.0, 0.0)
    phase_deg = min(180.0 + degrees(float(phase_rad[place])) for place in crossing)
    falling = np.flatnonzero((phase_rad[:-1] > -np.pi) & (phase_rad[1:] <= -np.pi))
    above = falling[falling >= crossing[0]]
    gain = float(1.0 / size[above[0]]) if len(above) else (inf if phase_deg > 0.0 else 0.0)
    return Margins(phase_deg, gain if phase_deg > 0.0 else min(gain, 1.0))


def _placed(bandwidth_rad_s: float, damping: float, share: float, loop: Loop) -> Gains:
    """Poles of the mean load at w."""
    inertia = float(np.exp(np.mean(np.log(loop.inertias_a_s2_rad))))
    proportional = inertia * bandwidth_rad_s**2
    derivative = max(2.0 * damping * inertia * bandwidth_rad_s - loop.viscous_a_s_rad, 0.0)
    return Gains(proportional, proportional * bandwidth_rad_s * share, derivative)
