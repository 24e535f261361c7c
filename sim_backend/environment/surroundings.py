"""What stands round a simulated joint: the operator at its arm, a wall in its way, and what truly acts between them."""

from dataclasses import replace

from sim_backend.plant.plant import Plant


class Hand:
    """The operator at a master arm, who takes hold of it and reaches from angle to angle.

    Args:
        plant: of the master; its `operator` says how heavy, stiff and strong the hand is.
    """

    def __init__(self, plant: Plant) -> None:
        self._plant = plant
        self._intended_rad = 0.0

    def take_hold(self) -> None:
        """Hold the arm where it is now."""
        self._intended_rad = self._plant.truth().arm_rad
        self.reach(self._intended_rad, 1.0)

    def reach(self, angle_rad: float, duration_s: float) -> None:
        """Reach from the angle that was to be reached last to another, beginning now: least jerk."""
        way_rad, held_rad = angle_rad - self._intended_rad, self._intended_rad
        self._intended_rad = angle_rad
        self._plant.take_hold(
            replace(
                self._plant.parameters.operator,
                present=True,
                hold_rad=held_rad,
                reach_rad=way_rad,
                reach_start_s=self._plant.time_s,
                reach_duration_s=duration_s,
                amplitude_rad=0.0,
            )
        )

    def torque_n_m(self) -> float:
        """Return the true torque of the hand on the arm [N m]."""
        return self._plant.truth().hand_n_m


class Surroundings:
    """What the arm of a slave meets."""

    def __init__(self, plant: Plant) -> None:
        self._plant = plant

    def put_wall(self, angle_rad: float | None) -> None:
        """Put a wall in the arm's way, or take it away.

        Args:
            angle_rad: where it stands; above 0 it stops positive motion, below 0 negative. None: nowhere.

        Raises:
            ParameterError: it would stand where the arm is, or is too stiff for the integration step.
        """
        wall = self._plant.parameters.wall
        if angle_rad is None:
            self._plant.put_wall(replace(wall, present=False))
            return
        wall = replace(wall, present=True, angle_rad=angle_rad)
        if (self._plant.truth().arm_rad - angle_rad) * angle_rad > 0.0:
            wall.refuse("angle_rad", "the arm stands beyond it")
        self._plant.put_wall(wall)

    def interaction_n_m(self) -> float:
        """Return the true torque that holds up load and arm, and presses the arm against the wall [N m]."""
        return self._plant.interaction_n_m()
