"""What one motor is told: its duty, or nothing more where the controller does not answer."""

from time import perf_counter

from drivers.errors import DriveConnectionError, DriveFault
from drivers.lateness import Lateness
from drivers.roboclaw.commands import CHANNELS, Read
from drivers.roboclaw.link import Link
from drivers.roboclaw.settings import RoboclawSettings


class Motor:
    """The duty of a motor.

    Args:
        link: open.
        settings: which motor.
        device: name used in messages.

    Attributes:
        counts: the duty that was told last [1/32767].
    """

    def __init__(self, link: Link, settings: RoboclawSettings, device: str) -> None:
        self.counts = 0
        self._link, self._device = link, device
        self._set_duty = CHANNELS[settings.motor].set_duty
        self._lateness = Lateness(device, "serial time-out", settings.set_watchdog_s)
        self._silent_until_s = 0.0

    def tell(self, counts: int) -> None:
        """Send a duty [1/32767].

        Raises:
            DriveConnectionError: it is not acknowledged.
        """
        self.counts = counts
        self._link.write(self._set_duty, counts)
        self._lateness.told()

    def tell_and_ask(self, counts: int, reads: tuple[Read, ...]) -> list[tuple[int, ...]] | None:
        """Send a duty and ask for data, at once; None where not all of it was answered, the duty perhaps neither."""
        self.counts = counts
        found = self._link.together(self._set_duty, counts, reads)
        if found is not None:
            self._lateness.told()
        return found

    def lateness_fault(self) -> DriveFault | None:
        """What has happened where the last duty was told too long ago."""
        return self._lateness.fault()

    def fall_silent(self) -> None:
        """Where it does not answer: one last word, then none, as every byte may put off its serial time-out."""
        self._link.shout(self._set_duty, 0)
        self._silent_until_s = perf_counter() + self._lateness.limit_s

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
                f"did not answer, and is left in silence so that its serial time-out ({self._lateness.limit_s:g} s) "
                "stops the motor; check the cable, then open it again",
            )
