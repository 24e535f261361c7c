"""A move from one set point to another with limited speed and acceleration."""

from math import ceil, copysign, sqrt
from typing import NamedTuple


class SetPoint(NamedTuple):
    """Position [rad] and speed [rad/s] that the servo is to follow."""

    position_rad: float
    velocity_rad_s: float


class Trapezoid:
    """Speed up, cruise, slow down; without a cruise where the way is short.

    Args:
        start_rad, end_rad: where from and where to.
        speed_rad_s, acceleration_rad_s2: never exceeded; above 0.
    """

    def __init__(self, start_rad: float, end_rad: float, speed_rad_s: float, acceleration_rad_s2: float) -> None:
        self._start_rad, self._end_rad = start_rad, end_rad
        way_rad = abs(end_rad - start_rad)
        self._sign = copysign(1.0, end_rad - start_rad)
        self._acceleration = acceleration_rad_s2
        self._peak = min(speed_rad_s, sqrt(way_rad * acceleration_rad_s2))
        self._ramp_s = self._peak / acceleration_rad_s2
        cruise_s = way_rad / self._peak - self._ramp_s if self._peak > 0.0 else 0.0
        self.duration_s = 2.0 * self._ramp_s + cruise_s

    def at(self, time_s: float) -> SetPoint:
        """The set point at a time since the start of the move."""
        if time_s >= self.duration_s:
            return SetPoint(self._end_rad, 0.0)
        remaining_s = self.duration_s - time_s
        if time_s < self._ramp_s:
            way_rad, speed = 0.5 * self._acceleration * time_s**2, self._acceleration * time_s
        elif remaining_s < self._ramp_s:
            way_rad = abs(self._end_rad - self._start_rad) - 0.5 * self._acceleration * remaining_s**2
            speed = self._acceleration * remaining_s
        else:
            way_rad, speed = self._peak * (time_s - 0.5 * self._ramp_s), self._peak
        return SetPoint(self._start_rad + self._sign * way_rad, self._sign * speed)


def run_up(start_rad: float, speed_rad_s: float, acceleration_rad_s2: float, period_s: float) -> list[SetPoint]:
    """From rest to a speed, either way: one set point per control period."""
    cycles = ceil(abs(speed_rad_s) / acceleration_rad_s2 / period_s)
    acceleration = copysign(acceleration_rad_s2, speed_rad_s)
    times_s = [cycle * period_s for cycle in range(1, cycles + 1)]
    return [SetPoint(start_rad + 0.5 * acceleration * t_s**2, acceleration * t_s) for t_s in times_s]


class Halt:
    """From a speed to rest.

    Args:
        start_rad: where braking begins.
        speed_rad_s: with which it begins, either way.
        acceleration_rad_s2: how hard; above 0.
    """

    def __init__(self, start_rad: float, speed_rad_s: float, acceleration_rad_s2: float) -> None:
        self._start_rad, self._speed = start_rad, speed_rad_s
        self._acceleration = copysign(acceleration_rad_s2, speed_rad_s)
        self.duration_s = abs(speed_rad_s) / acceleration_rad_s2

    def at(self, time_s: float) -> SetPoint:
        """The set point at a time since braking began."""
        time_s = min(time_s, self.duration_s)
        way_rad = self._speed * time_s - 0.5 * self._acceleration * time_s**2
        return SetPoint(self._start_rad + way_rad, self._speed - self._acceleration * time_s)
