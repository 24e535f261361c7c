"""One joint of a pair: its drive in the hands of the pair loop, cycle by cycle and at the end."""

from math import isnan, nan
from typing import NamedTuple

from bench.control.cycle import OFF, Action, Reading
from bench.control.limits import Guard
from bench.control.servo import CurrentServo
from bench.errors import ConfigurationError, LimitTrip
from drivers.contract import Command, Drive, Mode, Sample, Status
from drivers.errors import DriveStateError


class Exchanged(NamedTuple):
    """What one exchange gave: the reading, and the current by eq. (3), NaN where that is not known [A]."""

    reading: Reading
    estimate_a: float


class PairJoint:
    """One of the two.

    Args:
        name: "slave" or "master"; messages begin with it.
        drive: open and disabled.
        guard: its limits.
        current_servo: eq. (3); None where its rig does not say enough.
    """

    def __init__(self, name: str, drive: Drive, guard: Guard, current_servo: CurrentServo | None) -> None:
        self.name = name
        self.drive = drive
        self._guard = guard
        self._current_servo = current_servo
        self._has_current_mode = Mode.CURRENT in drive.describe().modes
        self._mode = Mode.OFF  # of the power stage
        self._origin_s = 0.0
        self._previous: Sample | None = None
        self._velocity_rad_s = 0.0

    @property
    def is_powered(self) -> bool:
        """Whether the stage has been powered and not been switched off again."""
        return self._mode is not Mode.OFF

    def begin(self, sample: Sample) -> Exchanged:
        """Begin a trial with a sample taken with the power off."""
        self._previous, self._velocity_rad_s, self._origin_s = None, 0.0, sample.time_s
        return self._read(sample)

    def is_stale(self, sample: Sample) -> bool:
        """Whether something in a sample is older than allowed."""
        return self._guard.is_stale(sample)

    def needs_switch(self, action: Action) -> bool:
        """Whether an action wants the stage in another mode."""
        return self._wire_mode(action.command.mode) is not self._mode

    def switch(self, action: Action) -> None:
        """Power the stage for an action, or take the power away."""
        mode = self._wire_mode(action.command.mode)
        # marked before the call: an `enable` that fails half-way may have powered the stage
        self._mode = mode
        if mode is Mode.OFF:
            self.drive.disable()
        else:
            self.drive.enable(mode)

    def exchange(self, action: Action) -> Exchanged:
        """Send an action in a mode that the drive closes itself; the reading that answers it."""
        return self._read(self.drive.exchange(self._wire_command(action.command)))

    def check(self, reading: Reading, target_rad: float) -> None:
        """Compare a reading with the limits, and the drive's state with what was asked of it.

        Raises:
            LimitTrip, DriveStateError: naming the joint.
            DriveFault: what the drive says of its fault.
        """
        try:
            self._guard.check(reading.sample, reading.velocity_rad_s, reading.current_a, target_rad)
        except LimitTrip as trip:
            raise LimitTrip(f"{self.name}: {trip}") from trip
        if self._mode is Mode.OFF or reading.sample.status is Status.ENABLED:
            return
        if reading.sample.status is Status.FAULT:
            self.drive.exchange(Command(self._mode, 0.0))  # a drive in fault refuses it, and says what the fault is
        raise DriveStateError(
            self.drive.describe().device,
            f"{self.name}: status is {reading.sample.status.name} during motion; ENABLED is wanted. See the drive's "
            "own display",
        )

    def coast(self) -> Exchanged:
        """One cycle without a demand: of a drive that brakes itself, or is off."""
        return self._read(self.drive.exchange(OFF))

    def power_off(self) -> list[str]:
        """Take the power away, and say what went wrong. Tried again when it fails or is interrupted."""
        notes = []
        for _ in range(3):
            try:
                self.drive.disable()
                break
            except BaseException as error:  # the power has to go, whatever happens meanwhile
                notes.append(f"{self.name}: power-off failed: {str(error) or type(error).__name__}")
        self._mode = Mode.OFF
        return notes

    def _wire_mode(self, mode: Mode) -> Mode:
        return Mode.DUTY if mode is Mode.CURRENT and not self._has_current_mode else mode

    def _wire_command(self, command: Command) -> Command:
        if command.mode is not Mode.CURRENT or self._has_current_mode:
            return command
        if self._current_servo is None or self._previous is None:
            raise ConfigurationError(
                f"{self.name}: the drive has no current mode, and the rig lacks the resistance, back-EMF constant or "
                "gear ratio that eq. (3) needs to do without; add them to the rig"
            )
        return Command(Mode.DUTY, self._current_servo.duty(command.value, self._previous, self._velocity_rad_s))

    def _read(self, sample: Sample) -> Exchanged:
        velocity_rad_s = self._derived_velocity(sample) if isnan(sample.velocity_rad_s) else sample.velocity_rad_s
        self._velocity_rad_s, self._previous = velocity_rad_s, sample
        servo = self._current_servo
        estimate_a = nan if servo is None else servo.estimate_a(sample, velocity_rad_s)
        current_a = estimate_a if isnan(sample.current_a) else sample.current_a
        return Exchanged(Reading(sample.time_s - self._origin_s, sample, velocity_rad_s, current_a), estimate_a)

    def _derived_velocity(self, sample: Sample) -> float:
        previous = self._previous
        if previous is None or sample.time_s <= previous.time_s:
            return self._velocity_rad_s
        return (sample.position_rad - previous.position_rad) / (sample.time_s - previous.time_s)
