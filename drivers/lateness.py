"""How late a host is: the drive's watchdog as the host knows it, where only a demand puts it off."""

from time import perf_counter

from drivers.errors import DriveConfigurationError, DriveFault


class Lateness:
    """Counts from the last demand.

    Args:
        device: name used in messages.
        watchdog: what the drive calls it.
        limit_s: silence after which the drive has stopped by itself [s].
    """

    def __init__(self, device: str, watchdog: str, limit_s: float) -> None:
        self.limit_s = limit_s
        self._device, self._watchdog = device, watchdog
        self._told_s = 0.0

    def check_period(self, period_s: float) -> None:
        """Compare the watchdog with a control period [s].

        Raises:
            DriveConfigurationError: the watchdog would stop the drive between two cycles.
        """
        if self.limit_s <= period_s:
            raise DriveConfigurationError(
                self._device,
                f"its {self._watchdog} would be {self.limit_s:g} s, and the control period is {period_s:g} s; "
                "a longer one is wanted: change watchdog_s",
            )

    def told(self) -> None:
        """A demand has gone out."""
        self._told_s = perf_counter()

    def fault(self) -> DriveFault | None:
        """What has happened where the last demand is older than the watchdog allows."""
        silent_s = perf_counter() - self._told_s
        if silent_s <= self.limit_s:
            return None
        return DriveFault(
            self._device,
            f"its {self._watchdog} has stopped the motor: no demand for {silent_s:.3g} s, {self.limit_s:g} s are "
            "allowed; see what kept the host busy, then start again",
        )
