"""A connected controller: from the open port, through all that keeps it safe, to its cycles."""

from time import perf_counter

from drivers.contract import Inspection, Sample, Status
from drivers.errors import DriveConfigurationError, DriveError
from drivers.joint import JointScale
from drivers.roboclaw.link import Link
from drivers.roboclaw.motor import Motor
from drivers.roboclaw.opening import identify, set_watchdog
from drivers.roboclaw.settings import RoboclawSettings
from drivers.roboclaw.telemetry import Telemetry


class Session:
    """Everything between connecting and disconnecting.

    Args:
        settings: how to reach it.
        joint: scales and signs.

    Raises:
        DriveError: at the first step that fails. The motor is stopped then where it can be told, and the port is free.
    """

    def __init__(self, settings: RoboclawSettings, joint: JointScale) -> None:
        device = settings.device
        self.link = Link(settings, device)
        self.motor = Motor(self.link, settings, device)
        self._asks_together = settings.questions == "together"
        try:
            self.identity = identify(self.link, device)
            self.motor.tell(0)
            set_watchdog(self.link, settings.watchdog_steps, device)
            self.telemetry = Telemetry(self.link, settings, joint)
            if self._asks_together:
                self._try_together(device)
        except BaseException:
            self.leave()
            raise

    def cycle(self, status: Status, counts: int) -> Sample:
        """Send a duty [1/32767], and ask for the sample.

        Args:
            status: of the power stage, for the sample.
            counts: the duty.

        Raises:
            DriveConnectionError: no valid answer within the time limit.
        """
        motor, telemetry = self.motor, self.telemetry
        before, sent_s = motor.counts, perf_counter()
        found = motor.tell_and_ask(counts, telemetry.quick) if self._asks_together else None
        if found is not None:
            times_s = [sent_s] * len(found)
        else:
            motor.tell(counts)
            found, times_s = telemetry.ask()
        sample = telemetry.sample(status, found, times_s)
        if before and not sample.duty:  # demanded and not applied: something has switched it off
            telemetry.read_status()
        return sample

    def inspect(self, status: Status) -> Inspection:
        """State, fault and applied output, by questions alone.

        Args:
            status: as it was told last; the controller tells of faults only.

        Raises:
            DriveConnectionError: no valid answer within the time limit.
        """
        telemetry = self.telemetry
        faults = telemetry.read_status()
        duty, current_a = telemetry.read_output()
        return Inspection(Status.FAULT if faults else status, ", ".join(faults), duty, current_a)

    def leave(self) -> None:
        """Stop the motor where it answers, and give the port back; otherwise its serial time-out stops it."""
        try:
            if not self.motor.is_left_in_silence:
                self.motor.tell(0)
        except DriveError:
            pass
        finally:
            self.link.close()

    def _try_together(self, device: str) -> None:
        """Find out whether the controller answers all of a cycle's questions where they come in one write."""
        self.link.begin()
        for _ in range(2):
            if self.motor.tell_and_ask(0, self.telemetry.quick) is not None:
                return
        raise DriveConfigurationError(
            device,
            'does not answer all questions of a cycle where they are asked together; set drive.questions = "in turn"',
        )
