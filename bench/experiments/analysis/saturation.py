"""When a held current or duty has brought the joint to its steady speed, and which speed to run up to next.

A joint that turns freely nears its steady speed w_s with a time constant T:  dw/dt = (w_s - w) / T. Travel may end
long before that: T can be a second, in which the joint turns 6 rad. So the steady speed is not waited for but sought:
each stroke is run up to another speed, and what it shows tells how much speed is still to come. From strokes

    that pass at different speeds:   where the line of dw/dt over w, of slope -1/T, comes to 0
    that arrive at the same speed:   that is it, whatever the run-up was; w_s is the fixed point of run-up -> speed

The speed is saturated where what is still to come is a small share of it.
"""

from enum import Enum
from math import inf, isnan, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FIRST_TIME_CONSTANT_S = 0.5  # until two strokes have shown it
LEAST_CHANGE = 0.1  # of the run-up: strokes closer than that do not tell whether they arrived
ARRIVED = 0.1  # of a difference in run-up: with less of it left, strokes have arrived
APART = 0.03  # of the speed: strokes closer than that do not show a time constant
NEAR = 0.6  # of the speed: strokes further off lie on another part of the friction curve
CLOSE = 1.5  # a stroke that stalls and one that does not are told apart no further than this ratio
LEAST_READINGS = 8  # of a window


class Ending(Enum):
    """How the search for a steady speed ended."""

    SATURATED = "saturated"
    STALLED = "stalled: below the friction at every speed"
    TOO_FAST = "its steady speed lies above top_speed_rad_s"
    NOT_SATURATED = "not saturated within the strokes allowed"


class Stroke(NamedTuple):
    """What one stroke showed, along its direction.

    Attributes:
        run_up_rad_s: speed that it was run up to.
        speed_rad_s: mean over the window; 0 where it stalled.
        acceleration_rad_s2: mean over the window; NaN where it stalled.
    """

    run_up_rad_s: float
    speed_rad_s: float
    acceleration_rad_s2: float

    @property
    def stalled(self) -> bool:
        """True when the joint came to rest."""
        return isnan(self.acceleration_rad_s2)


def motion_of(time_s: NDArray[np.float64], position_rad: NDArray[np.float64]) -> tuple[float, float]:
    """Mean speed [rad/s] and acceleration [rad/s2] by a parabola through the positions, shapes (n,).

    Far finer than speeds derived from one period, of which encoder counts are a good part.
    """
    mid_s = time_s - np.mean(time_s)
    half_acceleration, speed, _ = np.polyfit(mid_s, position_rad, 2)
    return float(speed), float(2.0 * half_acceleration)


def time_constant_s(strokes: list[Stroke]) -> float:
    """T, from a line of acceleration over speed through the strokes near the last one; NaN where they show none."""
    near = _near(strokes)
    speeds, accelerations = np.array([(one.speed_rad_s, one.acceleration_rad_s2) for one in near]).reshape(-1, 2).T
    if len(near) < 2 or np.ptp(speeds) <= APART * strokes[-1].speed_rad_s:
        return nan
    slope = float(np.polyfit(speeds, accelerations, 1)[0])
    return -1.0 / slope if slope < 0.0 else nan


def _near(strokes: list[Stroke]) -> list[Stroke]:
    last_rad_s = strokes[-1].speed_rad_s
    return [one for one in strokes if not one.stalled and abs(one.speed_rad_s - last_rad_s) <= NEAR * last_rad_s]


def remaining_rad_s(strokes: list[Stroke]) -> float:
    """Speed still to come after the last stroke; negative where the joint is slowing down, NaN where not known."""
    last = strokes[-1]
    others = [one for one in strokes[:-1] if not one.stalled and _share(one, last) < ARRIVED]
    if last.stalled:
        return nan
    hardly_changing = abs(last.acceleration_rad_s2) * FIRST_TIME_CONSTANT_S <= APART * last.speed_rad_s
    if others and hardly_changing:
        other = others[-1]
        share = _share(other, last)
        return share / (1.0 - share) * (last.speed_rad_s - last.run_up_rad_s)
    # the line's, not the last stroke's: teeth that part while it is measured falsify one stroke, not all of them
    near = _near(strokes)
    mean_speed, mean_acceleration = np.mean([(one.speed_rad_s, one.acceleration_rad_s2) for one in near], axis=0)
    return float(mean_speed + mean_acceleration * time_constant_s(strokes)) - last.speed_rad_s


def next_run_up(strokes: list[Stroke], tolerance: float, top_speed_rad_s: float) -> Ending | float:
    """The speed to run the next stroke up to, or how the search ended.

    Args:
        strokes: so far, one or more.
        tolerance: the speed is saturated when what is still to come is at most this share of it.
        top_speed_rad_s: never run up to more.
    """
    last = strokes[-1]
    if last.stalled:
        return _after_stall(strokes)
    remaining = remaining_rad_s(strokes)
    if abs(remaining) <= tolerance * last.speed_rad_s:
        return Ending.SATURATED
    if remaining > 0.0 and last.run_up_rad_s >= top_speed_rad_s:
        return Ending.TOO_FAST
    wanted = _first_guess(last) if isnan(remaining) else last.run_up_rad_s + remaining / _response(strokes)
    stalled_rad_s = max((one.run_up_rad_s for one in strokes if one.stalled), default=0.0)
    if wanted <= stalled_rad_s:
        wanted = (stalled_rad_s + last.run_up_rad_s) / 2.0
    wanted = min(wanted, top_speed_rad_s)
    if abs(wanted - last.run_up_rad_s) < LEAST_CHANGE * last.run_up_rad_s and isnan(remaining):
        wanted = (1.0 - 2.0 * LEAST_CHANGE) * last.run_up_rad_s
    return wanted


def _share(one: Stroke, last: Stroke) -> float:
    """How much of a difference in run-up is left when the speed is measured; above ARRIVED where it is too small."""
    apart_rad_s = one.run_up_rad_s - last.run_up_rad_s
    if abs(apart_rad_s) < LEAST_CHANGE * max(one.run_up_rad_s, last.run_up_rad_s):
        return inf
    return abs((one.speed_rad_s - last.speed_rad_s) / apart_rad_s)


def _response(strokes: list[Stroke]) -> float:
    """Change of speed per change of run-up; it scales the next step."""
    shares = [_share(one, strokes[-1]) for one in strokes[:-1] if not one.stalled]
    known = [share for share in shares if share < inf]
    return min(max(known[-1], 0.3), 1.0) if known else 1.0


def _first_guess(last: Stroke) -> float:
    change_rad_s = last.acceleration_rad_s2 * FIRST_TIME_CONSTANT_S
    return min(max(last.speed_rad_s + change_rad_s, 0.4 * last.speed_rad_s), 2.0 * last.speed_rad_s)


def _after_stall(strokes: list[Stroke]) -> Ending | float:
    """Below some speed the joint comes to rest. There may still be a steady speed between it and those that ran."""
    stalled_rad_s = max(one.run_up_rad_s for one in strokes if one.stalled)
    above = [one.run_up_rad_s for one in strokes if not one.stalled and one.run_up_rad_s > CLOSE * stalled_rad_s]
    return (stalled_rad_s + min(above)) / 2.0 if above else Ending.STALLED
