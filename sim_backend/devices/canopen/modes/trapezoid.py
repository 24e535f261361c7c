"""A move with limited speed and acceleration, re-planned every tick."""

from math import copysign, sqrt

from sim_backend.devices.axis import TICK_S


class Trapezoid:
    """Where a demanded position is on its way to a target. Units are counts and seconds."""

    def __init__(self) -> None:
        self.position = 0.0
        self.speed = 0.0
        self.target = 0.0

    def start(self, position: float) -> None:
        """Stand somewhere."""
        self.position = self.target = position
        self.speed = 0.0

    @property
    def done(self) -> bool:
        """Whether it stands at the target."""
        return self.speed == 0.0 and self.position == self.target

    def step(self, top_speed: float, acceleration: float, deceleration: float) -> None:
        """Go on by a tick."""
        left = self.target - self.position
        # the speed from which the rest of the way is just enough to stop, a tick ahead
        stopping = deceleration * TICK_S
        allowed = sqrt(max(2.0 * deceleration * abs(left) + 0.25 * stopping**2, 0.0)) - 0.5 * stopping
        wanted = copysign(min(top_speed, max(allowed, 0.0)), left)
        self._change_speed(wanted, acceleration, deceleration)
        if abs(left) <= abs(self.speed) * TICK_S + 1e-9 or (abs(left) < 0.5 and abs(self.speed) <= stopping):
            self.start(self.target)
        else:
            self.position += self.speed * TICK_S

    def halt(self, deceleration: float) -> None:
        """Go on by a tick, stopping."""
        self._change_speed(0.0, deceleration, deceleration)
        self.position += self.speed * TICK_S

    def _change_speed(self, wanted: float, acceleration: float, deceleration: float) -> None:
        slower = wanted * self.speed < 0.0 or abs(wanted) < abs(self.speed)
        step = (deceleration if slower else acceleration) * TICK_S
        self.speed += max(-step, min(step, wanted - self.speed))
