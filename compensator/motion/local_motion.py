"""Position, speed and acceleration from the last few encoder readings, and what is to be averaged beside them.

The acceleration is that of a parabola through the readings, by least squares: a sum of weights times positions. The
same number is the true acceleration averaged with a kernel, a bump over the window, whose second difference these
weights are. Position, speed, current, friction and load are averaged with that kernel, too: then motor torque minus
inertia times acceleration leaves nothing of a motion, however it swings within the window.

All of them belong to the middle of the window, (n - 1) / 2 periods ago.
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
    """Averages over the window: position [rad], speed [rad/s], acceleration [rad/s2]."""

    position_rad: float
    speed_rad_s: float
    acceleration_rad_s2: float


@dataclass(frozen=True)
class Window:
    """The weights of the readings, the oldest first.

    Attributes:
        position, speed, acceleration: what each position counts for.
        held: what each value counts for that was held for the period before its reading, as a current is.
    """

    position: tuple[float, ...]
    speed: tuple[float, ...]
    acceleration: tuple[float, ...]
    held: tuple[float, ...]

    def motion(self, positions_rad: Sequence[float]) -> Motion:
        """Of as many readings as there are weights."""
        return Motion(
            _dot(self.position, positions_rad), _dot(self.speed, positions_rad), _dot(self.acceleration, positions_rad)
        )

    def mean_held(self, values: Sequence[float]) -> float:
        """Average of what was held for a period each, such as currents."""
        return _dot(self.held, values)

    def mean(self, values: Sequence[float]) -> float:
        """Average of what goes with the positions, such as the load that they mean."""
        return _dot(self.position, values)

    def acceleration_noise_rad_s2(self, count_rad: float) -> float:
        """Standard deviation of the acceleration that counts of a size [rad] leave: 1/12 of variance each."""
        return count_rad * self.acceleration_noise_counts

    @cached_property
    def acceleration_noise_counts(self) -> float:
        """The same for counts of 1 rad."""
        return sqrt(sum(weight**2 for weight in self.acceleration) / 12.0)


@lru_cache(maxsize=32)
def window(readings: int, period_s: float) -> Window:
    """The weights for a number of readings, one period apart.

    Raises:
        ModelParameterError: too few readings, or a period that is not above 0.
    """
    if readings < LEAST_READINGS or not period_s > 0.0:
        raise ModelParameterError(
            f"window of {readings} readings every {period_s:g} s; allowed are at least {LEAST_READINGS}, above 0 s"
        )
    time_s = (np.arange(readings) - (readings - 1) / 2.0) * period_s
    acceleration = np.linalg.pinv(np.column_stack([np.ones(readings), time_s, 0.5 * time_s**2]))[2]
    # kernel of the second difference at each reading; 0 at either end of the window
    kernel = np.concatenate([[0.0], period_s**2 * np.cumsum(np.cumsum(acceleration))[:-2], [0.0]])
    around = np.concatenate([[0.0], kernel, [0.0]])
    # a speed is the difference of the positions on either side
    speed = (around[:-2] - around[2:]) / (2.0 * period_s)
    # a second difference at a reading is made by what was held before and after it
    held = (kernel + around[:-2]) / 2.0
    return Window(*(tuple(weights.tolist()) for weights in (kernel, speed, acceleration, held)))


def _dot(weights: tuple[float, ...], values: Sequence[float]) -> float:
    return float(sum(map(mul, weights, values)))
