"""A planar arm of two turning joints: where its tip is, and its Jacobian.

x = l1 cos(q1) + l2 cos(q1 + q2)        q1 from the x axis, q2 from the first link
y = l1 sin(q1) + l2 sin(q1 + q2)        det J = l1 l2 sin(q2): singular stretched out and folded back
"""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from compensator.errors import ModelParameterError
from compensator.motion.kinetic_friction import FloatArray


@dataclass(frozen=True)
class PlanarArm:
    """Two links.

    Attributes:
        first_m, second_m: lengths of the links; above 0.
    """

    first_m: float
    second_m: float

    def __post_init__(self) -> None:
        for name in ("first_m", "second_m"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise ModelParameterError(f"{name} is {getattr(self, name)} m; allowed is above 0 m")

    def tip_m(self, first_rad: float, second_rad: float) -> FloatArray:
        """Position of the tip, shape (2,)."""
        both_rad = first_rad + second_rad
        return np.array(
            [
                self.first_m * cos(first_rad) + self.second_m * cos(both_rad),
                self.first_m * sin(first_rad) + self.second_m * sin(both_rad),
            ]
        )

    def jacobian(self, first_rad: float, second_rad: float) -> FloatArray:
        """J [m], shape (2, 2): velocity of the tip per speed of each joint."""
        x_m, y_m = self.tip_m(first_rad, second_rad)
        both_rad = first_rad + second_rad
        return np.array([[-y_m, -self.second_m * sin(both_rad)], [x_m, self.second_m * cos(both_rad)]])
