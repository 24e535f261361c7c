"""The joint in the hand of its position servo: the parts that procedures are composed of, with `yield from`."""

from collections.abc import Generator, Iterable
from dataclasses import dataclass, replace
from math import ceil, inf, nan
from typing import TypeVar

from bench.config.configuration import BenchConfiguration
from bench.config.rig import resolution_rad
from bench.control.cycle import OFF, Action, Reading
from bench.control.servo import PositionServo
from bench.errors import ExperimentError
from bench.experiments.parts.profile import Halt, SetPoint, Trapezoid
from bench.experiments.parts.search import STILL_COUNTS, Found, begin_search
from compensator.rest.zero_speed_search import SearchReading
from drivers.contract import Command, Mode

_CURRENT = Mode.CURRENT  # at hand, see bench/control/cycle.py
_REFLECTED_CYCLES = 20
Result = TypeVar("Result")
Part = Generator[Action, Reading, Result]


@dataclass(frozen=True, slots=True)
class Steady:
    """The joint at rest in the dead-band.

    Attributes:
        position_rad: where it came to rest.
        current_a: mean motor current of the settled cycles, friction and all.
    """

    position_rad: float
    current_a: float


class Joint:
    """Parts of a procedure that move the joint.

    Args:
        configuration: of the bench; its rig must know gear ratio and encoder counts.

    Raises:
        ConfigurationError: the rig leaves out what is needed.
    """

    def __init__(self, configuration: BenchConfiguration) -> None:
        self._configuration = configuration
        self._motion = configuration.motion
        self._period_s = configuration.control.period_s
        self._dead_band_rad = configuration.servo.dead_band_rad
        self._servo = PositionServo(configuration.servo, self._period_s)
        self._drive_closes = configuration.servo.closed_by == "drive"
        self._still_rad = STILL_COUNTS * resolution_rad(configuration.rig)
        self._reading: Reading | None = None
        self._command_a = 0.0

    def wake(self) -> Part[Reading]:
        """Take the first reading with the power off; the servo starts from there."""
        self._servo.reset()
        self._reading = yield Action(OFF)
        return self._reading

    @property
    def reading(self) -> Reading:
        """The last one."""
        return self._last()

    @property
    def command_a(self) -> float:
        """The current that was asked for last; what flows, where the drive closes the position loop [A]."""
        return self._command_a

    def follow(self, set_points: Iterable[SetPoint], event: tuple[str, str] | None = None) -> Part[list[Reading]]:
        """Track one set point per cycle; the readings, one for each. The event is that of the first."""
        readings = []
        for target_rad, velocity_rad_s in set_points:
            reading = self._reading = yield self._towards(target_rad, velocity_rad_s, event=event)
            readings.append(reading)
            event = None
        return readings

    def step(
        self, target_rad: float, velocity_rad_s: float, load_current_a: float, half_width_a: float
    ) -> Part[Reading]:
        """One cycle towards a set point; the load current is recorded, with half of its 95 % interval."""
        action = self._towards(target_rad, velocity_rad_s, load_current_a, half_width_a=half_width_a)
        reading = self._reading = yield action
        return reading

    def move(
        self, target_rad: float, speed_rad_s: float | None = None, acceleration_rad_s2: float | None = None
    ) -> Part[None]:
        """Go to an angle; with speed and acceleration of the configuration where none are given."""
        speed_rad_s = self._motion.speed_rad_s if speed_rad_s is None else speed_rad_s
        acceleration = self._motion.acceleration_rad_s2 if acceleration_rad_s2 is None else acceleration_rad_s2
        start_rad = self._last().sample.position_rad
        profile = Trapezoid(start_rad, target_rad, speed_rad_s, acceleration)
        cycles = ceil(profile.duration_s / self._period_s)
        yield from self.follow(profile.at((cycle + 1) * self._period_s) for cycle in range(cycles))

    def rest_at(
        self, target_rad: float, speed_rad_s: float | None = None, acceleration_rad_s2: float | None = None
    ) -> Part[Steady]:
        """As `move`, then as `settle`."""
        yield from self.move(target_rad, speed_rad_s, acceleration_rad_s2)
        return (yield from self.settle(target_rad))

    def push(self, command: Command, event: tuple[str, str] | None = None) -> Part[Reading]:
        """One cycle of a command of one's own; no position is asked for."""
        self._command_a = command.value if command.mode is _CURRENT else self._command_a
        return (yield from self.act(Action(command, event=event)))

    def act(self, action: Action) -> Part[Reading]:
        """One cycle of an action of one's own."""
        reading = self._reading = yield action
        return reading

    def grip(self, dead_band_rad: float) -> None:
        """Let the servo of the bench work down to another error; `settle` keeps to that of the configuration."""
        self._servo.use(self._servo.settings.model_copy(update={"dead_band_rad": dead_band_rad}))

    def brake(self, acceleration_rad_s2: float) -> Part[None]:
        """From any speed to rest, after `push`; the servo takes over from the current that flows."""
        reading = self._last()
        start_rad, speed_rad_s = reading.sample.position_rad, reading.velocity_rad_s
        self._servo.reset(reading.current_a)
        halt = Halt(start_rad, speed_rad_s, acceleration_rad_s2)
        cycles = ceil(halt.duration_s / self._period_s)
        yield from self.follow(halt.at((cycle + 1) * self._period_s) for cycle in range(cycles))

    def settle(self, target_rad: float) -> Part[Steady]:
        """Wait until the joint rests in the dead-band.

        Raises:
            ExperimentError: it does not, in the time that the configuration gives it.
        """
        rest_rad, currents_a = nan, [0.0]
        settled_cycles = self._motion.settled_cycles
        for _ in range(ceil(self._motion.settle_timeout_s / self._period_s)):
            reading = self._reading = yield self._towards(target_rad)
            position_rad = reading.sample.position_rad
            in_place = abs(position_rad - target_rad) <= self._dead_band_rad
            if not in_place or not abs(position_rad - rest_rad) <= self._still_rad:
                rest_rad = position_rad
                currents_a.clear()
            currents_a.append(reading.current_a)
            if len(currents_a) > settled_cycles and in_place:
                return Steady(position_rad, sum(currents_a) / len(currents_a))
        raise ExperimentError(
            f"the joint did not settle within {self._dead_band_rad:.4g} rad of {target_rad:.4g} rad in "
            f"{self._motion.settle_timeout_s:g} s; it stands at {self._last().sample.position_rad:.4g} rad. "
            "Look at the servo's gains and the load"
        )

    def search(self, set_point_rad: float) -> Part[Found]:
        """The zero-speed search, round an angle at which the joint is settled."""
        search = begin_search(self._configuration, set_point_rad)
        reading, phase = self._last(), search.phase
        start_s, travel_rad = reading.time_s, 0.0
        while not search.finished:
            last_rad = reading.sample.position_rad
            current_a = search.advance(SearchReading(last_rad, reading.current_a, self._command_a))
            event = None if search.phase is phase else ("search", search.phase)
            phase = search.phase
            if current_a is None:
                action = self._towards(set_point_rad, event=event)
            else:
                self._command_a = current_a
                action = Action(Command(_CURRENT, current_a), set_point_rad, nan, event)
            reading = self._reading = yield action
            travel_rad += abs(reading.sample.position_rad - last_rad)
        return replace(search.found(), seconds=reading.time_s - start_s, travel_rad=travel_rad)

    def reflect(self, target_rad: float, load_current_a: float, half_width_a: float) -> Part[None]:
        """Hold an angle, and record the compensated current that the master would be given, with its interval."""
        for _ in range(_REFLECTED_CYCLES):
            self._reading = yield self._towards(target_rad, load_current_a=load_current_a, half_width_a=half_width_a)

    def _towards(
        self,
        target_rad: float,
        velocity_rad_s: float = 0.0,
        load_current_a: float = nan,
        event: tuple[str, str] | None = None,
        half_width_a: float = nan,
    ) -> Action:
        """The position servo's action for a set point, by the last reading."""
        reading = self._last()
        if self._drive_closes:
            self._command_a = reading.current_a  # what the drive's own servo makes flow
            command = Command(Mode.POSITION, target_rad)
        else:
            self._command_a = self._servo.current_a(
                target_rad, reading.sample.position_rad, reading.velocity_rad_s, velocity_rad_s
            )
            command = Command(_CURRENT, self._command_a)
        # nothing known is no number on record
        return Action(command, target_rad, load_current_a, event, half_width_a if half_width_a < inf else nan)

    def _last(self) -> Reading:
        if self._reading is None:
            raise ExperimentError("the procedure moves the joint before its first reading; begin with wake()")
        return self._reading
