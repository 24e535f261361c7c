"""The drive contract on one motor of a RoboClaw: signed duty in; position, applied duty, current, supply out."""

from time import perf_counter

from drivers.contract import Description, Inspection, Mode, Sample, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveError
from drivers.host_time import CycleTime, Lateness
from drivers.joint import JointScale, Standstill
from drivers.polled_drive import Identity, PolledDrive
from drivers.refusal import not_to_be_enabled
from drivers.roboclaw import commands
from drivers.roboclaw.commands import CHANNELS, DUTY_FULL, Read
from drivers.roboclaw.link import Link
from drivers.roboclaw.opening import VENDOR, identify, set_current_limit, set_watchdog
from drivers.roboclaw.settings import RoboclawSettings
from drivers.roboclaw.telemetry import Telemetry
from drivers.serial_latency import latency_note

_TRIES_TOGETHER = 3
_MODES = frozenset({Mode.DUTY})
_OPENING_QUESTIONS = 24  # at most, of which each may be met with silence


class Motor:
    """The duty of a motor.

    Attributes:
        counts: the duty that was told last [1/32767].
    """

    def __init__(self, link: Link, settings: RoboclawSettings) -> None:
        self.counts = 0
        self._link, self._device, self._watchdog_s = link, settings.device, settings.set_watchdog_s
        self._set_duty = CHANNELS[settings.motor].set_duty
        self._silent_until_s = 0.0

    def tell(self, counts: int) -> None:
        """Send a duty [1/32767].

        Raises:
            DriveConnectionError: it is not acknowledged.
        """
        self.counts = counts
        self._link.write(self._set_duty, counts)

    def tell_and_ask(self, counts: int, reads: tuple[Read, ...]) -> list[tuple[int, ...]] | None:
        """Send a duty and ask for data, at once; None where not all of it was answered, the duty perhaps neither."""
        self.counts = counts
        return self._link.together(self._set_duty, counts, reads)

    def fall_silent(self) -> None:
        """Send a duty of 0 once where it does not answer, then nothing: every byte may put off its serial time-out."""
        self._link.shout(self._set_duty, 0)
        self._silent_until_s = perf_counter() + self._watchdog_s

    @property
    def is_left_in_silence(self) -> bool:
        """Whether its serial time-out is waited for."""
        return perf_counter() < self._silent_until_s

    def check_silence(self) -> None:
        """Refuse to send while its serial time-out is waited for.

        Raises:
            DriveConnectionError: it is.
        """
        if self.is_left_in_silence:
            raise DriveConnectionError(
                self._device,
                f"did not answer, and is left in silence so that its serial time-out ({self._watchdog_s:g} s) "
                "stops the motor; check the cable, then open it again",
            )


class Session:
    """Everything between connecting and disconnecting.

    Attributes:
        told: the state that the motor was told last to be in; the controller itself knows of faults alone.
        notes: what the user should know of the line.

    Raises:
        DriveError: at the first step that fails. The motor is stopped then where it can be told, and the port is free.
    """

    def __init__(self, settings: RoboclawSettings, joint: JointScale) -> None:
        self._device, self._motor_sign = settings.device, joint.motor_sign
        self.told = Status.DISABLED
        self._has_failed = False
        self._braking = Standstill()
        self.link = Link(settings, settings.device)
        self.motor = Motor(self.link, settings)
        try:
            self.identity = identify(self.link, settings.device)
            self.motor.tell(0)
            set_watchdog(self.link, settings)
            set_current_limit(self.link, settings)
            self.telemetry = Telemetry(self.link, settings, joint)
            self._asks_together = settings.questions != "in turn" and self._answers_together(settings)
            self.notes = latency_note(settings.port, lambda: self.link.read(commands.APPLIED_DUTY))
        except BaseException:
            self.leave()
            raise

    @property
    def state(self) -> Status:
        """FAULT from the first report of one until it is cleared; else what was told last."""
        return Status.FAULT if self._has_failed else self.told

    def begin(self) -> None:
        """A call of the contract begins.

        Raises:
            DriveConnectionError: it did not answer, and its serial time-out is waited for in silence.
        """
        self.motor.check_silence()
        self.link.begin()

    def switch_on(self, _mode: Mode) -> None:
        """Let demands through, from a duty of 0 on; there is one mode."""
        if self.telemetry.read_status():
            self._has_failed = True
            raise not_to_be_enabled(self._device, self.fault_text())
        self.motor.tell(0)
        self.told = Status.ENABLED

    def switch_off(self) -> None:
        """Set the duty to 0."""
        self.told = Status.DISABLED
        self.motor.tell(0)

    def begin_quick_stop(self) -> None:
        """Brake with a duty of 0, until the count stands still."""
        if self.state is Status.ENABLED:
            self.told = Status.QUICK_STOP
            self._braking.restart()
        try:
            self.motor.tell(0)
        except DriveConnectionError:
            self._fall_silent()
            raise

    def clear_fault(self) -> None:
        """Ask whether the fault is gone: it has none to be reset."""
        self.switch_off()
        self._has_failed = bool(self.telemetry.read_status())

    def move(self, _mode: Mode, value: float) -> Sample:
        """One cycle with a duty, -1 .. 1."""
        return self._cycle(round(self._motor_sign * value * DUTY_FULL))

    def rest(self) -> Sample:
        """One cycle with a duty of 0."""
        if self.told is Status.ENABLED:
            self.told = Status.DISABLED
        return self._cycle(0)

    def inspect(self) -> Inspection:
        """Fault and applied output, by questions alone; of its state it tells nothing else."""
        faults = self.telemetry.read_status()
        duty, current_a = self.telemetry.read_output()
        return Inspection(Status.FAULT if faults else None, ", ".join(faults), duty, current_a)

    def fault_text(self) -> str:
        """The faults of the last status, by name."""
        return ", ".join(self.telemetry.faults) or "a fault that is gone by now"

    def leave(self) -> None:
        """Stop the motor where it answers, and give the port back; otherwise its serial time-out stops it."""
        try:
            if not self.motor.is_left_in_silence:
                self.motor.tell(0)
        except DriveError:
            pass
        finally:
            self.link.close()

    def _cycle(self, counts: int) -> Sample:
        """Send a duty [1/32767], ask for the sample, and follow the state."""
        try:
            sample = self._exchange(counts)
        except DriveConnectionError:
            self._fall_silent()
            raise
        if self.telemetry.faults and not self._has_failed:
            # the demand goes back to 0, so that the motor does not start when the fault goes
            self._has_failed = True
            self.switch_off()
            return sample._replace(status=Status.FAULT)
        if self.told is Status.QUICK_STOP and self._braking.stands(sample.position_rad):
            self.told = Status.DISABLED
        return sample

    def _exchange(self, counts: int) -> Sample:
        motor, telemetry = self.motor, self.telemetry
        before, sent_s = motor.counts, perf_counter()
        found = motor.tell_and_ask(counts, telemetry.quick) if self._asks_together else None
        if found is not None:
            times_s = [sent_s] * len(found)
        else:
            motor.tell(counts)
            found, times_s = telemetry.ask()
        sample = telemetry.sample(self.state, found, times_s)
        if before and not sample.duty:  # demanded and not applied: something has switched it off
            telemetry.read_status()
        return sample

    def _fall_silent(self) -> None:
        if self.state in (Status.ENABLED, Status.QUICK_STOP):
            self.motor.fall_silent()
            self.told = Status.DISABLED

    def _answers_together(self, settings: RoboclawSettings) -> bool:
        """Whether the controller answers all of a cycle's questions where they come in one write."""
        self.link.begin()
        answered = [self.motor.tell_and_ask(0, self.telemetry.quick) is not None for _ in range(_TRIES_TOGETHER)]
        if settings.questions == "together" and not any(answered):
            raise DriveConfigurationError(
                settings.device,
                "does not answer all questions of a cycle where they are asked together; set drive.questions = "
                '"in turn"',
            )
        return all(answered) or settings.questions == "together"


class RoboclawDrive(PolledDrive[Session]):
    """One brushed DC motor with its encoder.

    A RoboClaw has no state of its own between a demand and the next: a duty of 0 brakes, the serial time-out
    (commands 14 and 15) stops the motor, a fault stops it too. The states of the contract are kept in the session.
    """

    def __init__(self, settings: RoboclawSettings, joint: JointScale) -> None:
        super().__init__(
            settings.device,
            _MODES,
            Lateness(settings.device, "serial time-out", settings.set_watchdog_s),
            connect=lambda: Session(settings, joint),
            describe=lambda session, cycle: _describe(settings, session, cycle),
        )


def _describe(settings: RoboclawSettings, session: Session | None, cycle: CycleTime | None) -> Description:
    """Identity and capabilities; what only the controller knows is empty until it is open."""
    identity = Identity(VENDOR, "") if session is None else session.identity
    telemetry, link_s = None if session is None else session.telemetry, Link.longest_call_s(settings)
    notes = () if session is None or cycle is None else (*session.notes, cycle.note)
    return Description(
        device=settings.device,
        **identity._asdict(),
        modes=_MODES,
        measured=frozenset() if telemetry is None else telemetry.measured,
        resolution={} if telemetry is None else telemetry.resolution,
        max_rate_hz=0.0 if cycle is None else 1.0 / cycle.quickest_s,
        watchdog_s=settings.set_watchdog_s,
        longest_call_s=link_s,
        longest_open_s=_OPENING_QUESTIONS * link_s,
        notes=tuple(filter(None, notes)),
    )
