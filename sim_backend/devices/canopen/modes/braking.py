"""Stopping the motor at a deceleration, whatever the mode."""

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.canopen.modes.mode import Seen
from sim_backend.devices.canopen.modes.position_loop import PositionLoop

_SETTLES_S = 0.1  # of position control after the end of the ramp


class Braking:
    """A ramp of speed down to zero, kept by the position controller."""

    def __init__(self, loop: PositionLoop) -> None:
        self._loop = loop
        self._counts = 0.0
        self._speed = 0.0
        self._stands_s = 0.0
        self._no_ramp = False

    def start(self, seen: Seen) -> None:
        """Begin from the motion that there is."""
        self._counts, self._speed = seen.counts, seen.counts_per_s
        self._stands_s = 0.0
        self._no_ramp = False
        self._loop.start()

    @property
    def done(self) -> bool:
        """Whether the motor has been made to stand, or cannot be: a ramp of nothing brakes nothing."""
        return self._stands_s >= _SETTLES_S or self._no_ramp

    def torque(self, seen: Seen, deceleration: float) -> float:
        """Return the torque [permille] of the coming tick."""
        step = deceleration * TICK_S
        self._no_ramp = deceleration <= 0.0
        self._speed += max(-step, min(step, -self._speed))
        self._counts += self._speed * TICK_S
        if self._speed == 0.0:
            self._stands_s += TICK_S
        return self._loop.torque(self._counts, self._speed, seen)
