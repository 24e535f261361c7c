"""What a drive says where a call does not fit its state: the same words from each driver. Pure."""

from drivers.contract import Mode
from drivers.errors import DriveFault, DriveStateError


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
