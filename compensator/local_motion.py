"""Position, speed and acceleration from the last few encoder readings: a parabola through them, by least squares.

All three belong to the middle of the window, (n - 1) / 2 periods ago. What is measured beside them is averaged over
the same window, so that nothing is compared with something older.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import sqrt
from operator import mul
from typing import NamedTuple

import numpy as np

from compensator.errors import ModelParameterError

LEAST_READINGS = 5  # three unknowns, and some to average over


class Motion(NamedTuple):
    """At the middle of the window: position [rad], speed [rad/s], acceleration [rad/s2]."""

    position_rad: float
    speed_rad_s: float
    acceleration_rad_s2: float


@dataclass(frozen=True)
class Parabola:
    """The weights of the readings in each of the three.

    Attributes:
        position, speed, acceleration: one weight each per reading, the oldest first.
    """

    position: tuple[float, ...]
    speed: tuple[float, ...]
    acceleration: tuple[float, ...]

    def motion(self, positions_rad: Sequence[float]) -> Motion:
        """Of as many readings as there are weights, the oldest first."""
        return Motion(
            _dot(self.position, positions_rad), _dot(self.speed, positions_rad), _dot(self.acceleration, positions_rad)
        )

    def acceleration_noise_rad_s2(self, count_rad: float) -> float:
        """Standard deviation of the acceleration that counts of a size [rad] leave: 1/12 of variance each."""
        return count_rad * self.acceleration_noise_counts

    @cached_property
    def acceleration_noise_counts(self) -> float:
        """The same for counts of 1 rad."""
        return sqrt(sum(weight**2 for weight in self.acceleration) / 12.0)


@lru_cache(maxsize=32)
def parabola(readings: int, period_s: float) -> Parabola:
    """The weights for a number of readings, one period apart.

    Raises:
        ModelParameterError: too few readings, or a period that is not above 0.
    """
    if readings < LEAST_READINGS or not period_s > 0.0:
        raise ModelParameterError(
            f"window of {readings} readings every {period_s:g} s; allowed are at least {LEAST_READINGS}, above 0 s"
        )
    time_s = (np.arange(readings) - (readings - 1) / 2.0) * period_s
    rows = np.linalg.pinv(np.column_stack([np.ones(readings), time_s, 0.5 * time_s**2]))
    return Parabola(*(tuple(row) for row in rows.tolist()))


def _dot(weights: tuple[float, ...], values: Sequence[float]) -> float:
    return float(sum(map(mul, weights, values)))
