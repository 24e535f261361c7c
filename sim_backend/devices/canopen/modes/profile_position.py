"""Profile position (1): the drive plans the move to a target by itself."""

from math import copysign, sqrt

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import HALT, SET_POINT_TAKEN, TARGET_REACHED, Seen, Units
from sim_backend.devices.canopen.modes.position_loop import PositionLoop, within_limits
from sim_backend.devices.canopen.objects.drive_profile import NO_WINDOW

_NEW_SET_POINT, _AT_ONCE, _RELATIVE = 1 << 4, 1 << 5, 1 << 6


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


class ProfilePosition:
    """Target position (0x607A) in a trapezoid of 0x6081, 0x6083, 0x6084.

    A rising new-set-point bit hands over a target; the drive acknowledges in statusword bit 12 until the bit falls.
    With change-at-once the target counts now, else after the move under way; one target can wait.
    """

    def __init__(self, dictionary: Dictionary, loop: PositionLoop, units: Units) -> None:
        self._dictionary = dictionary
        self._loop = loop
        self._units = units
        self._profile = Trapezoid()
        self._waiting: float | None = None
        self._controlword = 0
        self._taken = False
        self._moving = False
        self._within_s = 0.0
        self._reached = False

    def start(self, seen: Seen) -> None:
        """Hold the position until a target comes."""
        self._profile.start(seen.counts)
        self._waiting = None
        self._controlword = self._dictionary.number(0x6040)
        self._taken = self._reached = False
        self._within_s = seen.time_s
        self._loop.start()

    def command(self, controlword: int) -> None:
        """Take a controlword."""
        rising = controlword & ~self._controlword
        self._controlword = controlword
        if not controlword & _NEW_SET_POINT:
            self._taken = self._waiting is not None
        elif rising & _NEW_SET_POINT and self._waiting is None:
            self._take(controlword)

    def torque(self, seen: Seen) -> float:
        """Return the torque [permille]."""
        top = self._units.counts_per_s(self._dictionary.number(0x6081))
        acceleration, deceleration = (
            self._units.counts_per_s2(self._dictionary.number(index)) for index in (0x6083, 0x6084)
        )
        if self._dictionary.number(0x6040) & HALT:
            self._profile.halt(deceleration)
        else:
            self._profile.step(top, acceleration, deceleration)
        if self._profile.done and self._waiting is not None:
            self._profile.target, self._waiting = self._waiting, None
            self._taken = bool(self._controlword & _NEW_SET_POINT)
        self._look_whether_reached(seen)
        return self._loop.torque(self._profile.position, self._profile.speed, seen) + self._dictionary.number(0x60B2)

    def position(self) -> float | None:
        """Return the position that is demanded [counts]."""
        return self._profile.position

    def status(self) -> int:
        """Whether a set point was taken, and the last one reached."""
        return (SET_POINT_TAKEN if self._taken else 0) | (TARGET_REACHED if self._reached else 0)

    def _take(self, controlword: int) -> None:
        asked = self._dictionary.number(0x607A)
        if controlword & _RELATIVE:
            target = self._units.counts(asked) + self._profile.target
        else:
            target = self._units.counts(within_limits(asked, self._dictionary))
        self._taken, self._reached = True, False
        if controlword & _AT_ONCE or self._profile.done:
            self._profile.target = target
        else:
            self._waiting = target

    def _look_whether_reached(self, seen: Seen) -> None:
        window = self._dictionary.number(0x6067)
        if self._dictionary.number(0x6040) & HALT:
            self._reached = self._profile.speed == 0.0
            return
        near = window == NO_WINDOW or abs(self._profile.target - seen.counts) <= self._units.counts(window)
        if not (self._profile.done and near):
            self._within_s = seen.time_s
            self._reached = False
        elif seen.time_s - self._within_s >= self._dictionary.number(0x6068) * 1e-3:
            self._reached = True
