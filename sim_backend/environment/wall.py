"""A wall in the arm's way, as a slave joint meets one while its master goes on."""

from dataclasses import dataclass

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
