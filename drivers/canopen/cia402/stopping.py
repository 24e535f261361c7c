"""How the drive stops by itself: on a ramp that is known to end soon, or by power-off at once.

On a quick stop, and in a fault, a drive brakes at 0x6085. As it is delivered that may take minutes, and nobody shortens
it where the host is gone. There the ramp is used only where the drive tells its unit. While the host is there, which
takes the power away in the end, that unit may be taken for the usual one.
"""

from dataclasses import dataclass
from math import ceil, isnan, nan
from typing import Final

from drivers.canopen.cia301.object_table import ObjectTable
from drivers.canopen.cia301.objects import (
    FAULT_REACTION_OPTION,
    QUICK_STOP_DECELERATION,
    QUICK_STOP_OPTION,
    DriveObject,
)
from drivers.canopen.cia402.scale import DriveScale

RAMP_S: Final = 0.25  # longest ramp: half of what a control loop gives a quick stop, for drives settle, and set brakes
USUAL_SPEED_RAD_S: Final = 8.0  # from which it has to stop, where nobody says
_OFF_AT_ONCE, _RAMP_THEN_OFF = 0, 2  # of 0x605A and 0x605E
_AT_ITS_LIMITS: Final = (3, 4)  # then off: brakes with all the current, or voltage, that it has
_MISTAKE: Final = 60.0  # in a unit that is not told: a minute for a second. A ramp that is so much steeper will do
_UNTOLD: Final = "A stop brakes as the drive does by itself, for it does not tell its ramp (0x6085)."
_PURPOSE: Final = "stop"


@dataclass(frozen=True, slots=True)
class Stopping:
    """What the drive does.

    Attributes:
        on_ramp: whether it may brake on its ramp while a host watches.
        ends: whether a quick stop that nobody watches is known to end soon in power-off.
    """

    on_ramp: bool
    ends: bool
    words: str


def set_up_stopping(table: ObjectTable, scale: DriveScale, speed_rad_s: float) -> Stopping:
    """Have quick stop and fault reaction end in power-off, soon."""
    time_s, why_not = _set_up_ramp(table, scale.acceleration_rad_s2, speed_rad_s)
    is_sure = time_s <= (RAMP_S if scale.tells_acceleration else RAMP_S / _MISTAKE)
    ends = _set_up_option(table, QUICK_STOP_OPTION, not why_not)
    words = f"A stop from {speed_rad_s:g} rad/s takes {time_s:.2g} s on the drive's ramp (0x6085); then power-off."
    if isnan(time_s):
        words = f"A stop takes the power off at once, for {why_not}." if why_not else _UNTOLD
    elif not is_sure:
        words += " The unit of 0x6085 (0x60AA) is not told; it is taken for that of velocity a second."
    if not why_not and not is_sure:
        words += " In a fault, and where this host is silent, the power is to go off at once."
    if not _set_up_option(table, FAULT_REACTION_OPTION, is_sure):
        words += (
            f" How long it brakes in a fault of its own is not known: {FAULT_REACTION_OPTION} "
            f"{table.outcome(FAULT_REACTION_OPTION, _PURPOSE)}. Set it to 0 with the drive's own tool."
        )
    return Stopping(not why_not, ends and (is_sure or bool(why_not)), words)


def _set_up_ramp(table: ObjectTable, unit_rad_s2: float, speed_rad_s: float) -> tuple[float, str]:
    """Have the ramp end in time.

    Returns:
        How long it takes [s], NaN where that is not known; and why it is not to be used, "" where it is.
    """
    ramp = table.ask(QUICK_STOP_DECELERATION, _PURPOSE)
    if ramp is None:
        return nan, ""
    if isnan(unit_rad_s2):
        return nan, f"the unit of {QUICK_STOP_DECELERATION} is told by neither drive nor velocity_unit"
    least = ceil(speed_rad_s / (RAMP_S * unit_rad_s2))
    if ramp < least:
        if not table.try_set(QUICK_STOP_DECELERATION, least, _PURPOSE):
            return nan, f"{QUICK_STOP_DECELERATION} is {ramp}, and cannot be {least}"
        ramp = least
    return speed_rad_s / (ramp * unit_rad_s2), ""


def _set_up_option(table: ObjectTable, option: DriveObject, on_ramp: bool) -> bool:
    """Set an option code; tell whether it ends soon in power-off."""
    before = table.ask(option, _PURPOSE)
    if before is None:
        return on_ramp  # CiA 402: by default it brakes on the quick-stop ramp, then switches off
    codes = (_RAMP_THEN_OFF, _OFF_AT_ONCE) if on_ramp else (_OFF_AT_ONCE,)
    return any(table.try_set(option, code, _PURPOSE) for code in codes) or before in (*codes, *_AT_ITS_LIMITS)
