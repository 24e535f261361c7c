"""The holding brake of a joint in the control loop: what the joint does while it is released or set.

The order: power on, hold, release, wait, move; at the end stand still, set, wait, let go of the torque and see that the
brake holds, power off. Where a run ends otherwise the brake is set at once, and nobody waits for it.
"""

from contextlib import suppress
from math import isnan, nan

from bench.config.configuration import BenchConfiguration
from bench.config.drives.kind import BrakeSettings
from bench.control.cycle import OFF, Action, Reading
from bench.control.servo import PositionServo
from bench.errors import ConfigurationError, LimitTrip, quantity_message
from drivers.contract import BrakeOutput, Command, Drive, Mode, OwnBrake

LOOK_S = 0.05  # under power with the brake set, before it is released
SINK_S = 0.1  # held on after it was released: a joint that sinks is seen
STAND_S = 0.2  # held before it is set, so that the joint stands
TRUST_S = 0.2  # without torque under the set brake, before the power goes


class Brake:
    """The brake of one joint.

    Attributes:
        is_released: whether it was told to be.
        wanted: what the joint was asked for when the watch over it began.

    Raises:
        ConfigurationError: the bench is to set it, and the drive has no output for it.
    """

    def __init__(self, bench: BenchConfiguration, drive: Drive) -> None:
        self.settings: BrakeSettings = bench.drive.brake
        self.is_released, self.wanted = False, Action(OFF)
        self._output = drive if self.settings.by == "output" and isinstance(drive, BrakeOutput) else None
        self._own = drive if self.settings.by == "drive" and isinstance(drive, OwnBrake) else None
        self._servo = PositionServo(bench.servo.model_copy(update={"dead_band_rad": 1e-9}), bench.control.period_s)
        self._start_rad, self._while, self._lets_go = nan, "", False
        if self.settings.by == "output" and self._output is None:
            raise ConfigurationError(
                f"drive.brake.by is 'output', and drive '{drive.describe().device}' (kind '{bench.drive.kind}') has no "
                "output that this bench can set; have the drive set it ('drive'), or use one that has"
            )

    @property
    def is_set_by_bench(self) -> bool:
        """Whether the bench sets it; else the drive does, with its power stage."""
        return self._output is not None

    def watch(self, reading: Reading, wanted: Action, while_: str) -> None:
        """From here on the joint is held where it is.

        Args:
            reading: the last one.
            wanted: what the joint is asked for beside; it is held in the same mode.
            while_: when it has to stay there, for a message; "": it may still come to rest.
        """
        self.wanted, self._lets_go, self._while = wanted, False, while_
        self._start_rad = reading.sample.position_rad
        self._servo.reset(0.0 if isnan(reading.current_a) else reading.current_a)

    def let_go(self) -> None:
        """From here on the joint is held by its brake alone."""
        self._lets_go = True

    def hold(self, reading: Reading) -> Action:
        """The action that holds the joint where the watch began.

        Where the motor is not known yet the duty is 0: the shorted winding holds the joint.
        """
        mode = self.wanted.command.mode
        if mode is Mode.POSITION:
            return Action(Command(mode, self._start_rad), self._start_rad)
        if mode is not Mode.CURRENT or self._lets_go:
            return Action(OFF if mode is Mode.OFF else Command(mode, 0.0))
        current_a = self._servo.current_a(self._start_rad, reading.sample.position_rad, reading.velocity_rad_s)
        return Action(Command(mode, current_a), self._start_rad)

    def check(self, reading: Reading, prefix: str) -> None:
        """Compare where the joint is with where it has to stay.

        Raises:
            LimitTrip: it has moved too far.
        """
        moved_rad = reading.sample.position_rad - self._start_rad
        if self._while and abs(moved_rad) > self.settings.move_rad:
            limit = self.settings.move_rad
            step = "See brake, load and drive.brake: its times, move_rad"
            raise LimitTrip(
                prefix + quantity_message(f"way {self._while}", moved_rad, f"{-limit:g} .. {limit:g}", "rad", step)
            )

    def release(self) -> None:
        """Release it; `settings.release_s` later the joint is free."""
        self.is_released = True  # before the call: one that fails may have released it
        if self._output is not None:
            self._output.set_brake(released=True)

    def set(self) -> None:
        """Set it; `settings.engage_s` later it holds."""
        if self._output is not None:
            self._output.set_brake(released=False)
        self.is_released = False

    def stand_down(self) -> None:
        """Have a drive that sets its brake itself do so while it still holds the joint, and switch off then."""
        if self._own is not None:
            self._own.stand_down(self.settings.engage_s)

    def drop(self) -> None:
        """Set it at once, and wait for nothing. Never raises: the power has to go, whatever happens."""
        if self._output is not None:
            with suppress(Exception):
                self._output.set_brake(released=False, confirmed=False)


def brake_of(bench: BenchConfiguration, drive: Drive) -> Brake | None:
    """The brake of a joint; None where it has none. Raises `ConfigurationError` as `Brake` does."""
    return None if bench.drive.brake.by == "none" else Brake(bench, drive)
