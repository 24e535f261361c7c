"""What no drive is sent: demands that are not finite, or outside its range."""

from math import isfinite

from drivers.contract import Mode
from drivers.errors import DriveConfigurationError


def check_demand(device: str, mode: Mode, value: float, limit: float, unit: str) -> None:
    """Compare a demand with the range that the drive takes, before anything is sent.

    Args:
        device: name used in the message.
        mode: what the value means.
        value: the demand, in `unit`.
        limit: largest magnitude, in `unit`.
        unit: SI unit; "" for a duty.

    Raises:
        DriveConfigurationError: not finite, or out of range.
    """
    if isfinite(value) and -limit <= value <= limit:
        return
    suffix = f" {unit}" if unit else ""
    raise DriveConfigurationError(
        device,
        f"{mode.value} demand is {value:g}{suffix}; -{limit:g} .. {limit:g}{suffix} is allowed. Limit the demand",
    )


def check_mode(device: str, mode: Mode, modes: frozenset[Mode]) -> None:
    """Refuse a mode that the drive does not have.

    Raises:
        DriveConfigurationError: naming the modes that it has.
    """
    if mode not in modes:
        names = ", ".join(sorted(known.value for known in modes))
        raise DriveConfigurationError(device, f"has no mode '{mode.value}', only {names}; choose one of these")
