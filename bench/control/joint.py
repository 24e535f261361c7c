"""One joint in the control loop: its drive, its limits, its current servo, and the state of its power stage."""

from math import isnan, nan

from bench.control.cycle import NOTHING, OFF, Action, reading_of
from bench.control.limits import Guard
from bench.control.power.brake import Brake
from bench.control.servo import CurrentServo
from bench.errors import ConfigurationError, LimitTrip
from drivers.contract import Command, Drive, Mode, Sample, Status
from drivers.errors import DriveStateError

_OFF, _DUTY, _CURRENT, _TORQUE = Mode.OFF, Mode.DUTY, Mode.CURRENT, Mode.TORQUE
_ENABLED = Status.ENABLED  # at hand, see cycle.py
_IDLE = Action(OFF)
POWER_OFF_TRIES = 3


class ControlledJoint:
    """What the control loop does with each of its joints.

    Args:
        drive: open and disabled.
        guard: the limits.
        current_servo: eq. (3); None where the rig does not say enough. Then there is no current estimate, and
            current commands need a drive with a current mode.
        name: messages begin with it; "" where there is one joint only.
        torque_constant_n_m_a: of the motor [N m/A]; NaN where the rig leaves it out. Then a drive that takes torques
            alone cannot be asked for a current.
        brake: the joint's holding brake; None where it has none, or is not to touch it.

    Attributes:
        demanded: mode of the last command that the power stage was switched for.
        prefix: the name, as messages begin with it.
    """

    def __init__(
        self,
        drive: Drive,
        guard: Guard,
        current_servo: CurrentServo | None = None,
        name: str = "",
        torque_constant_n_m_a: float = nan,
        brake: Brake | None = None,
    ) -> None:
        self.drive = drive
        self.brake = brake
        self._guard = guard
        self._current_servo = current_servo
        self.prefix = f"{name}: " if name else ""
        modes = drive.describe().modes
        self._lacks_current_mode = Mode.CURRENT not in modes
        self._stand_in = _TORQUE if _TORQUE in modes else _DUTY
        self._torque_constant_n_m_a = torque_constant_n_m_a
        self.action = _IDLE
        self.reading = NOTHING
        self.demanded = Mode.OFF
        self._mode = Mode.OFF  # of the power stage
        self._origin_s = 0.0

    @property
    def is_powered(self) -> bool:
        """Whether the stage has been powered and not been switched off again."""
        return self._mode is not _OFF

    @property
    def brakes(self) -> bool:
        """Whether the drive brakes by itself, by the last sample."""
        return self.reading.sample.status is Status.QUICK_STOP

    def begin(self) -> None:
        """Begin a trial with a sample taken with the power off: its time counts from there."""
        self.reading, self._origin_s = NOTHING, 0.0
        self.coast()
        self._origin_s = self.reading.time_s
        self.reading = self.reading._replace(time_s=0.0)

    def is_stale(self) -> bool:
        """Whether something in the last sample is older than allowed, or would soon be."""
        return self._guard.is_stale(self.reading.sample)

    def coast(self) -> None:
        """One exchange without a demand: before motion, or of a drive that brakes by itself."""
        self.action = _IDLE
        self.exchange()

    def hold(self) -> None:
        """Hold the joint where its brake's watch began, as the action of the next exchange."""
        if self.brake is not None:
            self.action = self.brake.hold(self.reading)

    def require_mode(self) -> None:
        """Refuse an action that neither the drive nor eq. (3) can do.

        Raises:
            ConfigurationError: a current is demanded that the drive cannot be asked for.
        """
        if self._wire_mode() is self.action.command.mode:
            return
        if self._stand_in is _TORQUE and isnan(self._torque_constant_n_m_a):
            raise ConfigurationError(
                f"{self.prefix}the drive takes torques, not currents, and the rig leaves out "
                "motor.torque_constant_n_m_a that makes one of the other; add it to the rig (1 where all is to be said "
                "in N m)"
            )
        if self._stand_in is _DUTY and self._current_servo is None:
            raise ConfigurationError(
                f"{self.prefix}the drive has no current mode, and the rig lacks the resistance, back-EMF constant or "
                "gear ratio that the paper's eq. (3) needs to do without; add them to the rig"
            )

    def switch(self) -> bool:
        """Power the stage for the action, or take the power away; False where it stands as it has to."""
        wanted = self._wire_mode()
        stands = wanted is self._mode
        # marked before the call: an `enable` that fails half-way may have powered the stage
        self.demanded, self._mode = self.action.command.mode, wanted
        if stands:
            return False
        if wanted is _OFF:
            self.drive.disable()
            self._leave_brake()
        else:
            self.drive.enable(wanted)
        return True

    def exchange(self) -> None:
        """Send the action, in a mode that the drive closes itself, and take the reading that answers it."""
        self.take(self.drive.exchange(self.wire_command()))

    def wire_command(self) -> Command:
        """The action's command, in a mode that the drive closes itself."""
        command, servo = self.action[0], self._current_servo
        if not self._lacks_current_mode or command[0] is not _CURRENT:
            return command
        if self._stand_in is _TORQUE:
            return Command(_TORQUE, command[1] * self._torque_constant_n_m_a)
        if servo is None:
            return command
        previous, velocity_rad_s = self.reading[1:3]
        return Command(_DUTY, servo.duty(command[1], previous, velocity_rad_s))

    def take(self, sample: Sample) -> None:
        """Make the reading of a sample."""
        servo = self._current_servo
        estimate = None if servo is None else servo.estimate_a
        self.reading = reading_of(sample, self.reading, self._origin_s, estimate, self._torque_constant_n_m_a)

    def check(self, target_rad: float) -> None:
        """Compare the reading with the limits, and the drive's state with what was asked of it.

        Raises:
            LimitTrip, DriveStateError: naming the joint, where it has a name.
            DriveFault: what the drive says of its fault.
        """
        sample, velocity_rad_s, current_a = self.reading[1:4]
        try:
            self._guard.check(sample, velocity_rad_s, current_a, target_rad)
        except LimitTrip as trip:
            raise LimitTrip(f"{self.prefix}{trip}") from trip
        if self._mode is not _OFF and sample[8] is not _ENABLED:
            self._refuse_state(sample.status)

    def check_brake(self) -> None:
        """Compare where the joint is with where it has to stay meanwhile.

        Raises:
            LimitTrip: it moves with its brake set, or sinks when that is released.
        """
        if self.brake is not None:
            self.brake.check(self.reading, self.prefix)

    def quick_stop(self) -> None:
        """Have the drive brake, where it is powered; its holding brake is set at once, too."""
        if self.brake is not None:
            self.brake.drop()
        if self.is_powered:
            self.drive.quick_stop()

    def power_off(self) -> list[str]:
        """Take the power away, and say what went wrong. Tried again when it fails or is interrupted."""
        notes = []
        if self.brake is not None and self.brake.is_released:
            self.brake.drop()
        for _ in range(POWER_OFF_TRIES):
            try:
                self.drive.disable()
                break
            except BaseException as error:  # the power has to go, whatever happens meanwhile
                notes.append(f"{self.prefix}power-off failed: {str(error) or type(error).__name__}")
        self.demanded = self._mode = Mode.OFF
        self._leave_brake()
        if self.brake is not None and self.brake.is_released:
            try:
                self.brake.set()
            except Exception as error:
                notes.append(f"{self.prefix}the brake is not set: {error}")
        return notes

    def _leave_brake(self) -> None:
        """The power is off: a drive that sets its brake by itself has done so."""
        if self.brake is not None and not self.brake.is_set_by_bench:
            self.brake.is_released = False

    def _wire_mode(self) -> Mode:
        """The mode that the drive is sent the action in."""
        mode = self.action.command.mode
        return self._stand_in if mode is _CURRENT and self._lacks_current_mode else mode

    def _refuse_state(self, status: Status) -> None:
        if status is Status.FAULT:
            self.exchange()  # a drive in fault refuses the command, and says what the fault is
        raise DriveStateError(
            self.drive.describe().device,
            f"{self.prefix}status is {status.name} during motion; ENABLED is wanted. See the drive's own display",
        )
