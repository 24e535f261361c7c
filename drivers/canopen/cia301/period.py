"""Which control periods a drive on a bus can have: its watchdog and the load of the bus say."""

from collections.abc import Iterable
from typing import Final

from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError

_OVERHEAD_BITS = 47  # of a frame with an 11-bit identifier, with the gap to the next (ISO 11898-1)
_STUFFING = 1.2  # stuff bits: one in five of what they apply to, at worst
_WATCHDOG_PERIODS: Final = 2  # cycles that the watchdog has to outlast


def check_period(settings: CanopenSettings, period_s: float) -> None:
    """Compare a control period [s] with the watchdog.

    Raises:
        DriveConfigurationError: it is too long, or none.
    """
    longest_s = settings.watchdog_s / _WATCHDOG_PERIODS
    if not 0.0 < period_s <= longest_s:
        raise DriveConfigurationError(
            settings.device,
            f"control period {period_s:g} s: more than 0 and at most {longest_s:g} s (half the watchdog) is wanted; "
            "change the period or watchdog_s",
        )


def check_bus_load(settings: CanopenSettings, loads: Iterable[tuple[int, ...]], period_s: float) -> None:
    """Compare a control period [s] with what the frames of a cycle take on the bus.

    Args:
        settings: with the bit rate.
        loads: bytes of the frames of each drive on the bus; the first is SYNC, which goes out once.
        period_s: the control period [s].

    Raises:
        DriveConfigurationError: it is too short.
    """
    fastest_s = cycle_s((0, *(size for load in loads for size in load[1:])), settings.bus.bitrate)
    if period_s < fastest_s:
        raise DriveConfigurationError(
            settings.device,
            f"control period {period_s:g} s: the frames of a cycle take {fastest_s:.3g} s on this bus; "
            "at least that is wanted; change the period or the bit rate",
        )


def cycle_s(payload_bytes: tuple[int, ...], bitrate: int) -> float:
    """Longest time that frames need [s]."""
    return sum((_OVERHEAD_BITS + 8 * size) * _STUFFING for size in payload_bytes) / bitrate
