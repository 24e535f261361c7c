"""What every drive refuses, in the same words: demands out of range, calls that do not fit its state. Pure."""

from math import isfinite

from drivers.contract import Mode
from drivers.errors import DriveConfigurationError, DriveFault, DriveStateError


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
        others = f"only {names}; choose one of these" if modes else "nor any other; 'friction-bench doctor' says why"
        raise DriveConfigurationError(device, f"has no mode '{mode.value}', {others}")


def not_open(device: str, call: str) -> DriveStateError:
    """A call came before `open`."""
    return DriveStateError(device, f"{call} before open; call open(period_s) first")


def not_enabled(device: str, mode: Mode, state: str) -> DriveStateError:
    """Motion was commanded in a mode that is not enabled; `state` is what the drive is in."""
    return DriveStateError(device, f"a {mode.value} was demanded in state {state}; enable {mode.value} mode first")


def not_to_be_enabled(device: str, why: str) -> DriveStateError:
    """The power cannot be switched on, for a fault or a state that `why` names."""
    return DriveStateError(device, f"cannot be enabled: {why}; remove the cause, clear the fault, then enable it again")


def not_cleared(device: str, why: str) -> DriveFault:
    """A fault that `why` names is still there."""
    return DriveFault(device, f"cannot be cleared: {why}; remove the cause, then clear it")


def switched_itself_off(device: str, why: str) -> DriveFault:
    """The drive is off by its own doing, for what `why` names."""
    return DriveFault(device, f"has switched itself off: {why}; remove the cause, then clear the fault")
