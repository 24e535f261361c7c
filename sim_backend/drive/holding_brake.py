"""The coil of a holding brake, and when the brake follows it."""

from sim_backend.plant.plant import Plant


class HoldingBrake:
    """Sets and releases the brake of a plant. It is set until its coil has had current for long enough."""

    def __init__(self, plant: Plant) -> None:
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
