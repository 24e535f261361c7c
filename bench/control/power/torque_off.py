"""Safe torque off (STO): the drive has no power because its safety circuit is open, and the joint is not at fault.

Drives tell it in different ways: a bit of their own, or a fault of that name.
"""

from drivers.contract import Drive, Inspection, Status

_NAMED = ("safe torque off", "emergency stop", "e-stop")
NEXT_STEP = "release the emergency stop, close the guard or the enable input"


def torque_off(found: Inspection) -> str:
    """What says that it is active; "" where nothing does."""
    named = any(name in found.fault.lower() for name in _NAMED)
    return found.torque_off or (found.fault if named else "")


def torque_off_reason(drive: Drive) -> str:
    """Why a drive that gave an error has no power, and what to do; "" where safe torque off is not the reason."""
    try:
        found = drive.inspect()
    except Exception:  # what is asked here explains an error that is known already
        return ""
    seen = torque_off(found)
    return sentence(drive.describe().device, seen, found.status is Status.FAULT) if seen else ""


def sentence(device: str, seen: str, is_latched: bool) -> str:
    """What a person is told.

    Args:
        device: of the drive.
        seen: what says so.
        is_latched: the drive keeps it as a fault until that is cleared.
    """
    clear = ", clear the fault ('friction-bench drive clear-fault')" if is_latched else ""
    return (
        f"safe torque off is active at drive '{device}' ({seen}); the joint is not at fault. See why it was asked for, "
        f"{NEXT_STEP}{clear}, then start again"
    )
