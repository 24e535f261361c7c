"""A holding brake on the motor shaft, its coil, and when the brake follows it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from sim_backend.plant.component import Component, quantity

if TYPE_CHECKING:  # a plant is made with one
    from sim_backend.plant.plant import Plant


@dataclass(frozen=True, kw_only=True)
class Brake(Component):
    """Spring-applied: without current in its coil it holds, as dry friction of so much torque at the motor shaft.

    Without torque there is none. It takes time either way: the coil has to pull the armature off the springs, and the
    field has to decay before they push it back.
    """

    torque_n_m: float = quantity("N m", at_least=0, default=0.0)
    release_s: float = quantity("s", at_least=0, default=0.05)
    engage_s: float = quantity("s", at_least=0, default=0.03)


class HoldingBrake:
    """Sets and releases the brake of a plant. It is set until its coil has had current for long enough.

    Args:
        plant: with the brake; without torque nothing happens.

    Attributes:
        is_released: whether the coil has current.
    """

    def __init__(self, plant: "Plant") -> None:
        self._plant = plant
        self.is_released = False
        self._follows_s = 0.0
        self._holds = True
        if plant.parameters.brake.torque_n_m > 0.0:
            plant.hold_by_brake(True)

    @property
    def holds(self) -> bool:
        """Whether it holds the joint by now."""
        return self._holds

    def energise(self, released: bool) -> None:
        """Switch the coil."""
        if released != self.is_released:
            brake = self._plant.parameters.brake
            self.is_released = released
            self._follows_s = self._plant.time_s + (brake.release_s if released else brake.engage_s)

    def advance(self) -> None:
        """Let the brake follow its coil, when it is time."""
        if self._holds == self.is_released and self._plant.time_s >= self._follows_s:
            self._holds = not self.is_released
            if self._plant.parameters.brake.torque_n_m > 0.0:
                self._plant.hold_by_brake(self._holds)
