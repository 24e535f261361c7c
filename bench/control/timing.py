"""Whether a drive keeps up with the control period, and watches over it: checked before motion."""

from collections.abc import Sequence

from bench.errors import ConfigurationError
from drivers.contract import Description

SLOWEST_WATCHDOG_S = 2.0  # a joint without its host may not go on for longer
_PERIODS_IN_WATCHDOG = 2.0  # one late cycle is no reason to switch off


def check_timing(drive: Description, period_s: float) -> None:
    """Compare rate and watchdog of a drive with the control period.

    Raises:
        ConfigurationError: the drive is too slow, or its watchdog too quick or too slow; with the numbers.
    """
    shortest_s = 1.0 / drive.max_rate_hz
    if period_s < shortest_s:
        raise ConfigurationError(
            f"control.period_s is {period_s:g} s; drive '{drive.device}' sustains {drive.max_rate_hz:.4g} cycles a "
            f"second, so at least {shortest_s:.2g} s is wanted. {_advice(drive)}"
        )
    least_s = _PERIODS_IN_WATCHDOG * period_s
    if drive.watchdog_s is not None and not least_s <= drive.watchdog_s <= SLOWEST_WATCHDOG_S:
        raise ConfigurationError(
            f"the watchdog of drive '{drive.device}' stops it after {drive.watchdog_s:g} s; {least_s:g} s (two control "
            f"periods) .. {SLOWEST_WATCHDOG_S:g} s is wanted. Change drive.watchdog_s or control.period_s"
        )


def _advice(drive: Description) -> str:
    """What to do about a slow drive: what was noticed of line and host, or else what helps in general."""
    return " ".join(drive.notes) or "Choose a longer period or a faster line"


def check_pair_timing(drives: Sequence[Description], period_s: float) -> None:
    """Compare what drives take that are asked one after the other with the control period.

    Raises:
        ConfigurationError: together they are too slow.
    """
    shortest_s = sum(1.0 / drive.max_rate_hz for drive in drives)
    if period_s < shortest_s:
        names = " and ".join(f"'{drive.device}'" for drive in drives)
        raise ConfigurationError(
            f"control.period_s is {period_s:g} s; drives {names}, one after the other in each cycle, take "
            f"{shortest_s:.2g} s. Choose a longer period or a faster line"
        )
