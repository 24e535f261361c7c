"""The drive contract on one motor of a RoboClaw: signed duty in; position, applied duty, current, supply out."""

from drivers.contract import Command, Description, Drive, Inspection, Mode, Sample, Status
from drivers.demand import check_demand, check_mode
from drivers.errors import DriveConnectionError
from drivers.joint import JointScale
from drivers.lateness import Lateness
from drivers.rate import sustained_rate_hz
from drivers.refusal import not_cleared, not_enabled, not_open, not_to_be_enabled, switched_itself_off
from drivers.roboclaw.commands import DUTY_FULL
from drivers.roboclaw.description import MODES, describe
from drivers.roboclaw.motor import Motor
from drivers.roboclaw.session import Session
from drivers.roboclaw.settings import RoboclawSettings
from drivers.standstill import Standstill


class RoboclawDrive(Drive):
    """One brushed DC motor with its encoder.

    A RoboClaw has no state of its own between a demand and the next: a duty of 0 brakes, the serial time-out
    (commands 14 and 15) stops the motor, a fault stops it too. The states of the contract are kept here.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: RoboclawSettings, joint: JointScale) -> None:
        self._settings, self._joint = settings, joint
        self._device = settings.device
        self._session: Session | None = None
        self._rate_hz = 0.0
        self._state = Status.DISABLED
        self._braking = Standstill()

    # the contract --------------------------------------------------------------------------------

    def describe(self) -> Description:
        """Identity and capabilities; what is measured and the rate are known once it is open."""
        return describe(self._settings, self._session, self._rate_hz)

    def open(self, period_s: float) -> None:
        """Connect, identify, stop the motor, set the serial time-out and read it back, and find the rate.

        Raises:
            DriveConnectionError: the port is not there, or nothing answers on it.
            DriveConfigurationError: what answers is no RoboClaw, the time-out is shorter than the period, or questions
                that are asked together are not all answered.
            WatchdogError: the serial time-out cannot be set.
        """
        self.close()
        Lateness(self._device, "serial time-out", self._settings.set_watchdog_s).check_period(period_s)
        self._session = Session(self._settings, self._joint)
        try:
            self._rate_hz = sustained_rate_hz(lambda: self.exchange(Command(Mode.OFF)))
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Stop the motor and give the port back."""
        session, self._session = self._session, None
        self._state = Status.DISABLED
        if session is not None:
            session.leave()

    def enable(self, mode: Mode) -> None:
        """Let demands through, from a duty of 0 on.

        Raises:
            DriveConfigurationError: a mode other than duty.
            DriveStateError: it is not open, or has a fault.
            DriveConnectionError: no answer in time.
        """
        session = self._opened("enable")
        check_mode(self._device, mode, MODES)
        session.link.begin()
        faults = session.telemetry.read_status()
        if faults:
            self._state = Status.FAULT
            raise not_to_be_enabled(self._device, _listed(faults))
        session.motor.tell(0)
        self._state = Status.ENABLED

    def disable(self) -> None:
        """Set the duty to 0; a fault stays until it is cleared."""
        session = self._opened("disable")
        if self._state is not Status.FAULT:
            self._state = Status.DISABLED
        session.link.begin()
        session.motor.tell(0)

    def quick_stop(self) -> None:
        """Brake with a duty of 0, until the count stands still."""
        session = self._opened("quick_stop")
        session.link.begin()
        if self._state is Status.ENABLED:
            self._state = Status.QUICK_STOP
            self._braking.restart()
        try:
            session.motor.tell(0)
        except DriveConnectionError:
            self._fall_silent(session.motor)
            raise

    def inspect(self) -> Inspection:
        """State, fault and applied output; questions alone are asked.

        Raises:
            DriveStateError: it is not open.
            DriveConnectionError: no answer in time.
        """
        session = self._opened("inspect")
        session.link.begin()
        return session.inspect(self._state)

    def clear_fault(self) -> None:
        """Ask whether the fault is gone. The drive is left disabled.

        Raises:
            DriveFault: its cause is still there.
        """
        session = self._opened("clear_fault")
        session.link.begin()
        session.motor.tell(0)
        faults = session.telemetry.read_status()
        if faults:
            raise not_cleared(self._device, _listed(faults))
        self._state = Status.DISABLED

    def exchange(self, command: Command) -> Sample:
        """Send a duty, and ask for the sample of this cycle.

        Raises:
            DriveFault: the controller reports a fault, or its serial time-out has passed.
            DriveStateError: it is not open, or motion was commanded while it is not enabled.
            DriveConfigurationError: a mode other than duty, or a duty outside -1 .. 1.
            DriveConnectionError: no valid answer within the time limit.
        """
        mode, value = command.mode, command.value
        session = self._opened("exchange")
        session.link.begin()
        counts = 0
        if mode is not Mode.OFF:
            self._check_motion(session, mode, value)
            counts = round(self._joint.motor_sign * value * DUTY_FULL)
        elif self._state is Status.ENABLED:
            self._state = Status.DISABLED
        try:
            sample = session.cycle(self._state, counts)
        except DriveConnectionError:
            self._fall_silent(session.motor)
            raise
        if session.telemetry.faults and self._state is not Status.FAULT:
            # the demand goes back to 0, so that the motor does not start when the fault goes
            self._state = Status.FAULT
            session.motor.tell(0)
            sample = sample._replace(status=self._state)
        if self._state is Status.QUICK_STOP and self._braking.stands(sample.position_rad):
            self._state = Status.DISABLED
        return sample

    # the inside ----------------------------------------------------------------------------------

    def _opened(self, call: str) -> Session:
        if self._session is None:
            raise not_open(self._device, call)
        self._session.motor.check_silence()
        return self._session

    def _fall_silent(self, motor: Motor) -> None:
        if self._state in (Status.ENABLED, Status.QUICK_STOP):
            motor.fall_silent()
            self._state = Status.DISABLED

    def _check_motion(self, session: Session, mode: Mode, value: float) -> None:
        """Refuse a demand that the state does not allow, or that no drive can follow."""
        if self._state is Status.FAULT:
            raise switched_itself_off(self._device, _listed(session.telemetry.faults))
        check_mode(self._device, mode, MODES)
        if self._state is not Status.ENABLED:
            raise not_enabled(self._device, mode, self._state.name.lower())
        check_demand(self._device, mode, value, 1.0, "")
        fault = session.motor.lateness_fault()
        if fault is not None:
            self._state = Status.DISABLED
            session.motor.tell(0)
            raise fault


def _listed(faults: list[str]) -> str:
    return ", ".join(faults) or "a fault that is gone by now"
