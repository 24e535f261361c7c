"""End stops: the range beyond which the arm cannot turn."""

from dataclasses import dataclass
from math import pi

from sim_backend.environment.obstacle import Surface
from sim_backend.plant.component import quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Wall(Surface):
    """A wall at an angle. The arm comes from angle 0: a wall above it stops positive motion, one below negative."""

    angle_rad: float = quantity("rad", default=1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.angle_rad == 0.0:
            self.refuse("angle_rad", "the arm rests at angle 0, and a body cannot stand in a wall")


@jitted
def wall_depth(wall: Wall, angle_rad: float) -> float:
    """Return how deep the arm is in the wall [rad], signed as the wall's angle; 0 where it does not touch."""
    if not wall.present:
        return 0.0
    beyond_rad = angle_rad - wall.angle_rad
    return beyond_rad if beyond_rad * wall.angle_rad > 0.0 else 0.0


@dataclass(frozen=True, kw_only=True)
class EndStops(Surface):
    """Two stops, one at either end of the arm's range, of the same make."""

    lower_rad: float = quantity("rad", default=-pi)
    upper_rad: float = quantity("rad", default=pi)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.lower_rad >= 0.0:
            self.refuse("lower_rad", "the arm rests at angle 0: the lower stop must be below 0")
        if self.upper_rad <= 0.0:
            self.refuse("upper_rad", "the arm rests at angle 0: the upper stop must be above 0")

    def check_reach(self, wall_rad: float) -> None:
        """Refuse stops that keep the arm from a wall.

        Raises:
            ParameterError: the wall lies at a stop, or beyond.
        """
        name = "upper_rad" if wall_rad > 0.0 else "lower_rad"
        if not self.lower_rad < wall_rad < self.upper_rad:
            self.refuse(name, f"the wall at {wall_rad:g} rad lies beyond it, and the arm never gets there")


@jitted
def stop_depth(stops: EndStops, angle_rad: float) -> float:
    """Return how deep the arm is in a stop [rad], negative in the lower one; 0 between them."""
    if not stops.present:
        return 0.0
    if angle_rad > stops.upper_rad:
        return angle_rad - stops.upper_rad
    return min(angle_rad - stops.lower_rad, 0.0)
