"""What a host needs of time: how late its demands are, how quick a cycle is, and what it has lost to other programs."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import NamedTuple

from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveFault

ATTEMPTS = 2  # of a question whose answer does not come, or not intact
_CYCLES = 15
_SCHEDULER = Path("/proc/thread-self/schedstat")  # ns on the processor, ns ready and waiting for it, turns
_BUSY_SHARE = 0.25  # of a cycle; a host that waits for more of it has no time to judge a line by


class Lateness:
    """The drive's watchdog by the host's clock: counts from the last demand.

    Args:
        device: name used in messages.
        watchdog: what the drive calls it.
        limit_s: silence after which the drive stops by itself [s]; None: nothing stops it.
    """

    def __init__(self, device: str, watchdog: str, limit_s: float | None) -> None:
        self.limit_s = limit_s
        self._device, self._watchdog = device, watchdog
        self._told_s = 0.0

    def check_period(self, period_s: float) -> None:
        """Compare the watchdog with a control period [s].

        Raises:
            DriveConfigurationError: the watchdog would stop the drive between two cycles.
        """
        if self.limit_s is not None and self.limit_s <= period_s:
            raise DriveConfigurationError(
                self._device,
                f"its {self._watchdog} would be {self.limit_s:g} s, and the control period is {period_s:g} s; "
                "a longer one is wanted: change watchdog_s",
            )

    def told(self, at_s: float) -> None:
        """A demand went out at a time [s] of `perf_counter`."""
        self._told_s = at_s

    def fault(self) -> DriveFault | None:
        """What is wrong where the last demand is older than the watchdog allows: the drive is taken for stopped."""
        silent_s = perf_counter() - self._told_s
        if self.limit_s is None or silent_s <= self.limit_s:
            return None
        return DriveFault(
            self._device,
            f"no demand for {silent_s:.3g} s, and its {self._watchdog} allows {self.limit_s:g} s: it counts as "
            "stopped, and is switched off. See what kept the host busy, then start again",
        )


class CycleTime(NamedTuple):
    """What some cycles took.

    Attributes:
        quickest_s: without what the host waited for its processor [s]: what drive and line need.
        host_s: what it waited in a cycle, the median [s]; 0 where the system does not tell.
    """

    quickest_s: float
    host_s: float

    @property
    def note(self) -> str:
        """What the user should know; "" where the host had its time."""
        if self.host_s < _BUSY_SHARE * self.quickest_s:
            return ""
        return (
            f"this host is busy: a cycle waits for its processor for {1e3 * self.host_s:.2g} ms, drive and line take "
            f"{1e3 * self.quickest_s:.2g} ms. Cycles will be late; end what else runs here"
        )


def measure_cycle(cycle: Callable[[], object]) -> CycleTime:
    """Whole cycles one after the other, with the power off.

    The quickest counts: a busy host is no fault of the drive, and is seen in the cycles that are lost later. The system
    may count a wait late, in the cycle after: one that seems to have waited for all its time says nothing.
    """
    lasted_s, waited_s = [], []
    for _ in range(_CYCLES):
        began_s, before_s = perf_counter(), processor_wait_s()
        cycle()
        lasted_s.append(perf_counter() - began_s)
        waited_s.append(processor_wait_s() - before_s)
    own_s = (lasted - waited for lasted, waited in zip(lasted_s, waited_s, strict=True))
    return CycleTime(min((own for own in own_s if own > 0.0), default=min(lasted_s)), median(waited_s))


def processor_wait_s() -> float:
    """Time [s] that this thread has waited for a processor so far; 0 where the system does not tell."""
    with suppress(OSError, ValueError, IndexError):
        return int(_SCHEDULER.read_text(encoding="ascii").split()[1]) * 1e-9
    return 0.0


def host_was_away(elapsed_s: float, longest_s: float, limit_s: float) -> str:
    """Words for a message about an answer that did not come in time, where the host was late itself; else "".

    Args:
        elapsed_s: what asking took [s].
        longest_s: what it could take at most, by its time limits [s].
        limit_s: longest wait for one answer [s].
    """
    away_s = elapsed_s - longest_s
    if away_s < _BUSY_SHARE * limit_s:
        return ""
    return f"; this host itself was {1e3 * away_s:.2g} ms late, so the line may be sound: end what else runs here"


def no_answer(
    device: str, what: str, check: str, limit_s: float, began_s: float, rest_s: float = 0.0
) -> DriveConnectionError:
    """A question was asked `ATTEMPTS` times at most, and not answered.

    Args:
        device: name used in the message.
        what: was asked for, and what was found: "registers: found nothing".
        check: what to look at beside cable and power.
        limit_s: longest wait for one answer [s].
        began_s: when it was asked first, of `perf_counter` [s].
        rest_s: that the line is given after an answer that has not come [s].
    """
    away = host_was_away(perf_counter() - began_s, ATTEMPTS * (limit_s + rest_s), limit_s)
    return DriveConnectionError(
        device,
        f"{what} within {limit_s:g} s, asked {ATTEMPTS} times at most; check the cable, the power, {check}{away}",
    )
