"""What one motor is told: its duty, or nothing more where the controller does not answer."""

from time import perf_counter

from drivers.errors import DriveConnectionError
from drivers.roboclaw.commands import CHANNELS, Read
from drivers.roboclaw.link import Link
from drivers.roboclaw.settings import RoboclawSettings


class Motor:
    """The duty of a motor.

    Args:
        link: open.
        settings: which motor.

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
