"""A joint and its drive in the hands of a control loop, cycle by cycle and at the end."""

from math import nan

from bench.cycle import OFF, Reading
from bench.errors import ConfigurationError, LimitTrip
from bench.limits import Guard
from bench.servo import CurrentServo
from drivers.contract import Command, Drive, Mode, Sample, Status
from drivers.errors import DriveStateError


class DrivenJoint:
    """One joint of a bench.

    Args:
        drive: open and disabled.
        guard: its limits.
        current_servo: eq. (3); None where its rig does not say enough. Then there is no current estimate, and current
            commands need a drive with a current mode.
        name: "slave" or "master" of a pair: messages begin with it; "" of a joint that is alone.

    Attributes:
        last_reading: None before the first trial.
    """

    def __init__(self, drive: Drive, guard: Guard, current_servo: CurrentServo | None, name: str = "") -> None:
        self.drive = drive
        self.last_reading: Reading | None = None
        self._guard = guard
        self._current_servo = current_servo
        self._prefix = f"{name}: " if name else ""
        # how a current is commanded: the drive closes the loop, or eq. (3) does by the duty, or nothing can
        self._current_mode = Mode.DUTY if current_servo is not None else None
        if Mode.CURRENT in drive.describe().modes:
            self._current_mode = Mode.CURRENT
        self._mode = Mode.OFF  # of the power stage
        self._sent = OFF
        self._origin_s = 0.0

    @property
    def is_powered(self) -> bool:
        """Whether the stage has been powered and not been switched off again."""
        return self._mode is not Mode.OFF

    def is_stale(self, sample: Sample) -> bool:
        """Whether something in a sample is older than allowed."""
        return self._guard.is_stale(sample)

    def begin(self, sample: Sample) -> Reading:
        """Begin a trial with a sample taken with the power off; its time is 0."""
        self.last_reading, self._origin_s = None, sample.time_s
        return self._read(sample)

    def power_for(self, command: Command) -> bool:
        """Put the stage into the mode that a command needs; True where that was another one, and took its time.

        Raises:
            ConfigurationError: a current is commanded, and there is neither a current mode nor eq. (3).
        """
        mode = command.mode if command.mode is not Mode.CURRENT else self._current_mode
        if mode is self._mode:
            return False
        if mode is None:
            raise ConfigurationError(
                f"{self._prefix}the drive has no current mode, and the rig lacks the resistance, back-EMF constant or "
                "gear ratio that eq. (3) needs to do without; add them to the rig"
            )
        # marked before the call: an `enable` that fails half-way may have powered the stage
        self._mode = mode
        if mode is Mode.OFF:
            self.drive.disable()
        else:
            self.drive.enable(mode)
        return True

    def exchange(self, command: Command) -> Reading:
        """One cycle: send a command, after `power_for`, in a mode that the drive closes itself; read the answer."""
        if command.mode is Mode.CURRENT and self._current_mode is Mode.DUTY:
            command = Command(Mode.DUTY, self._duty(command.value))
        self._sent = command
        return self._read(self.drive.exchange(command))

    def check(self, reading: Reading, target_rad: float) -> None:
        """Compare a reading with the limits, and the drive's state with what was asked of it.

        Raises:
            LimitTrip, DriveStateError: naming the joint where there are two.
            DriveFault: what the drive says of its fault.
        """
        sample = reading.sample
        try:
            self._guard.check(sample, reading.velocity_rad_s, reading.current_a, target_rad)
        except LimitTrip as trip:
            raise LimitTrip(f"{self._prefix}{trip}") from trip
        if sample.status is Status.ENABLED or self._mode is Mode.OFF:
            return
        if sample.status is Status.FAULT:
            self.drive.exchange(self._sent)  # a drive in fault refuses it, and says what the fault is
        raise DriveStateError(
            self.drive.describe().device,
            f"{self._prefix}status is {sample.status.name} during motion; ENABLED is wanted. See the drive's own "
            "display",
        )

    def coast(self) -> Reading:
        """One cycle without a demand: of a drive that brakes itself, or is off."""
        return self._read(self.drive.exchange(OFF))

    def quick_stop(self, known: str) -> list[str]:
        """Have the drive brake, and say what went wrong and is not known yet."""
        try:
            self.drive.quick_stop()
        except BaseException as error:  # a second Ctrl-C, too: on to power-off
            return self.problem("quick stop failed", error, known)
        return []

    def power_off(self) -> list[str]:
        """Take the power away, and say what went wrong. Tried again when it fails or is interrupted."""
        notes = []
        for _ in range(3):
            try:
                self.drive.disable()
                break
            except BaseException as error:  # the power has to go, whatever happens meanwhile
                notes += self.problem("power-off failed", error)
        self._mode = Mode.OFF
        return notes

    def problem(self, what: str, error: BaseException, known: str | None = None) -> list[str]:
        """What to say of an error while a run ends; nothing where it is known."""
        why = str(error) or type(error).__name__
        return [] if known is not None and why in known else [f"{self._prefix}{what}: {why}"]

    def _duty(self, current_a: float) -> float:
        reading, servo = self.last_reading, self._current_servo
        assert reading is not None  # `begin` came before
        assert servo is not None  # else `power_for` has refused
        return servo.duty(current_a, reading.sample, reading.velocity_rad_s)

    def _read(self, sample: Sample) -> Reading:
        velocity_rad_s, current_a, servo = sample.velocity_rad_s, sample.current_a, self._current_servo
        if velocity_rad_s != velocity_rad_s:  # NaN
            velocity_rad_s = self._derived_velocity(sample)
        estimate_a = nan if servo is None else servo.estimate_a(sample, velocity_rad_s)
        if current_a != current_a:
            current_a = estimate_a
        reading = Reading(sample.time_s - self._origin_s, sample, velocity_rad_s, current_a, estimate_a)
        self.last_reading = reading
        return reading

    def _derived_velocity(self, sample: Sample) -> float:
        last = self.last_reading
        if last is None:
            return 0.0
        elapsed_s = sample.time_s - last.sample.time_s
        if elapsed_s <= 0.0:
            return last.velocity_rad_s
        return (sample.position_rad - last.sample.position_rad) / elapsed_s
