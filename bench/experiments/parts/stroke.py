"""One stroke through the travel: run up to a speed, hold a current, a duty or that speed, brake before the end."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from math import ceil, nan, sqrt
from typing import NamedTuple

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.rig import resolution_rad
from bench.control.cycle import Reading
from bench.errors import LimitError, OutOfRange, quantity_message
from bench.experiments.analysis.saturation import LEAST_READINGS, Stroke, motion_of
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.profile import SetPoint, run_up
from bench.experiments.parts.search import STILL_COUNTS
from drivers.contract import Command, Mode

MARGIN_RAD = 0.15  # at either end, for what the servo overshoots
OVERSPEED = 1.1  # of the top speed: holding ends there, so that a run-up to the top speed still shows something
WINDOW_SHARE = 0.5  # of what is held, the later part: by then the run-up has died away


class Held(Enum):
    """What is held constant."""

    CURRENT = "current"
    DUTY = "duty"
    SPEED = "speed"


@dataclass(frozen=True, slots=True)
class StrokeSettings:
    """How every stroke is run.

    Attributes:
        top_speed_rad_s: fastest run-up; holding ends, and braking begins, a tenth above it.
        hold_s: longest time that is held.
        window_s: shortest window that is measured.
    """

    low_rad: float
    high_rad: float
    top_speed_rad_s: float
    acceleration_rad_s2: float
    hold_s: float
    window_s: float

    def greatest_speed_rad_s(self) -> float:
        """The fastest that the travel lets one measure: v^2 / a to run up and brake, v times the hold in between."""
        least_hold_s = self.window_s / WINDOW_SHARE
        a, way_rad = self.acceleration_rad_s2, self.high_rad - self.low_rad
        return a / 2.0 * (sqrt(least_hold_s**2 + 4.0 * max(way_rad, 0.0) / a) - least_hold_s)


class Window(NamedTuple):
    """What one stroke measured, along its direction; means over the window.

    Attributes:
        stroke: speed and acceleration.
        current_a: of the motor, measured or by eq. (3).
        measured_current_a: NaN where the drive measures none.
        duty, supply_v: as applied, as measured.
        seconds: length of the window.
    """

    stroke: Stroke
    current_a: float
    measured_current_a: float
    duty: float
    supply_v: float
    seconds: float


def refuse_travel(name: str, speed_rad_s: float, settings: StrokeSettings) -> None:
    """Raise `LimitError` for a speed that cannot be run up to, measured and braked from within the travel."""
    greatest = settings.greatest_speed_rad_s()
    if speed_rad_s > greatest:
        why = (
            f"Run-up and braking with {settings.acceleration_rad_s2:g} rad/s2 and a window of {settings.window_s:g} s "
            f"have to fit into {settings.low_rad:.4g} .. {settings.high_rad:.4g} rad: ask for less, or use an arm that "
            "may turn further (limits.position_min_rad, limits.position_max_rad)"
        )
        message = quantity_message(name, speed_rad_s, f"at most {greatest:.4g}", "rad/s", why)
        raise LimitError(message, OutOfRange(name, speed_rad_s, "rad/s", high=greatest))


class Strokes:
    """Strokes of one trial, all in one direction; each begins at the near end of the travel.

    Args:
        configuration: of the bench.
        settings: of every stroke.
        held, level: what is held, and how much of it; above 0.
        sign: direction, 1 or -1.
    """

    def __init__(
        self, configuration: BenchConfiguration, settings: StrokeSettings, held: Held, level: float, sign: float
    ) -> None:
        self._settings = settings
        self._held, self._level, self._sign = held, sign * level, sign
        self._joint = Joint(configuration)
        self._period_s = configuration.control.period_s
        self._still_rad = STILL_COUNTS * resolution_rad(configuration.rig)
        self._move_rad_s = configuration.motion.speed_rad_s
        self._settled_cycles = configuration.motion.settled_cycles
        self._near_rad, self._far_rad = settings.low_rad, settings.high_rad
        if sign < 0.0:
            self._near_rad, self._far_rad = self._far_rad, self._near_rad

    def begin(self) -> Part[None]:
        """Take the first reading."""
        yield from self._joint.wake()

    def end(self) -> Part[None]:
        """Back to angle 0, where the joint may be left without power."""
        yield from self._go(0.0)

    def run(self, run_up_rad_s: float) -> Part[Window]:
        """One stroke.

        Args:
            run_up_rad_s: speed at which holding begins; 0 begins from rest.
        """
        acceleration = self._settings.acceleration_rad_s2
        yield from self._go(self._near_rad)
        yield from self._joint.settle(self._near_rad)
        yield from self._joint.follow(run_up(self._near_rad, self._sign * run_up_rad_s, acceleration, self._period_s))
        if self._held is Held.SPEED:
            readings = yield from self._joint.follow(self._cruise(run_up_rad_s))
        else:
            readings = yield from self._hold()
        yield from self._joint.brake(acceleration)
        return self._window(readings, run_up_rad_s)

    def _go(self, target_rad: float) -> Part[None]:
        """With the acceleration of the strokes: what the motor can give a heavy arm, near the end of its travel."""
        yield from self._joint.move(target_rad, self._move_rad_s, self._settings.acceleration_rad_s2)

    def _cruise(self, speed_rad_s: float) -> Iterator[SetPoint]:
        """Set points at a steady speed, while the time and the travel last."""
        start_rad = self._near_rad + self._sign * speed_rad_s**2 / (2.0 * self._settings.acceleration_rad_s2)
        for cycle in range(1, ceil(self._settings.hold_s / self._period_s) + 1):
            if self._must_brake():
                return
            way_rad = speed_rad_s * cycle * self._period_s
            yield SetPoint(start_rad + self._sign * way_rad, self._sign * speed_rad_s)

    def _hold(self) -> Part[list[Reading]]:
        """Hold the current or the duty until the time, the travel or the speed allowed is used up, or it stands."""
        command = Command(Mode.CURRENT if self._held is Held.CURRENT else Mode.DUTY, self._level)
        readings: list[Reading] = []
        rest_rad, still_cycles = nan, 0
        for _ in range(ceil(self._settings.hold_s / self._period_s)):
            reading = yield from self._joint.push(command)
            readings.append(reading)
            position_rad = reading.sample.position_rad
            if not abs(position_rad - rest_rad) <= self._still_rad:
                rest_rad, still_cycles = position_rad, 0
            still_cycles += 1
            if still_cycles > 2 * self._settled_cycles or self._must_brake():
                break
        return readings

    def _must_brake(self) -> bool:
        """Whether the way that braking takes, from the cycle after next, or the speed allowed is used up."""
        reading = self._joint.reading
        left_rad = self._sign * (self._far_rad - reading.sample.position_rad)
        speed_rad_s = max(self._sign * reading.velocity_rad_s, 0.0)
        braking_rad = speed_rad_s**2 / (2.0 * self._settings.acceleration_rad_s2) + 2.0 * speed_rad_s * self._period_s
        return left_rad <= braking_rad or speed_rad_s >= OVERSPEED * self._settings.top_speed_rad_s

    def _window(self, readings: list[Reading], run_up_rad_s: float) -> Window:
        count = max(ceil(WINDOW_SHARE * len(readings)), LEAST_READINGS)
        window = readings[-count:]
        time_s = np.array([reading.time_s for reading in window])
        position_rad = self._sign * np.array([reading.sample.position_rad for reading in window])
        if len(window) > self._settled_cycles and np.ptp(position_rad[-self._settled_cycles :]) <= self._still_rad:
            window, motion = window[-self._settled_cycles :], (0.0, nan)
        elif len(window) < LEAST_READINGS:
            # over the top speed almost at once
            speed_rad_s = self._sign * window[-1].velocity_rad_s
            motion = speed_rad_s, (speed_rad_s - run_up_rad_s) / (len(window) * self._period_s)
        else:
            motion = motion_of(time_s, position_rad)
        means = np.mean(
            [(one.current_a, one.sample.current_a, one.sample.duty, one.sample.supply_v) for one in window], axis=0
        )
        current_a, measured_current_a, duty, supply_v = means.tolist()
        return Window(
            Stroke(run_up_rad_s, *motion),
            self._sign * current_a,
            self._sign * measured_current_a,
            self._sign * duty,
            supply_v,
            len(window) * self._period_s,
        )
