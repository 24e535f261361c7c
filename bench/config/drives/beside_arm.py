"""Who stands beside the arms of a pair: a person, or software beside an arm that is simulated in this process."""

from collections.abc import Callable
from typing import Any, Protocol


class Hand(Protocol):
    """The operator at the master."""

    def take_hold(self) -> None:
        """Hold the arm where it is."""

    def reach(self, angle_rad: float, duration_s: float) -> None:
        """Reach for an angle, beginning now."""

    def torque_n_m(self) -> float:
        """What the hand does to the arm; NaN where nobody knows."""


class Environment(Protocol):
    """What the slave's arm meets."""

    def put_wall(self, angle_rad: float | None) -> None:
        """Have a wall at an angle, or none."""

    def interaction_n_m(self) -> float:
        """Torque that load and wall truly take; NaN where nobody knows."""


BesideArm = Callable[[Any], tuple[Hand, Environment]]
"""Makes both for the arm of a drive of the kind."""
