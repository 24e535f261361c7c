"""Which of the drive's modes of operation does what the contract asks for (CiA 402-2, 0x6060 and 0x6502)."""

from math import isnan
from typing import Final

from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import (
    PROFILE_ACCELERATION,
    PROFILE_DECELERATION,
    PROFILE_VELOCITY,
    SUPPORTED_MODES,
    TARGET_POSITION,
    TARGET_TORQUE,
    TARGET_VELOCITY,
    TORQUE_SLOPE,
    DriveObject,
)
from drivers.canopen.cia402.scale import DriveScale
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Mode

PROFILE_POSITION: Final = 1
PROFILE_VELOCITY_MODE: Final = 3
PROFILE_TORQUE: Final = 4
CYCLIC_POSITION: Final = 8
CYCLIC_VELOCITY: Final = 9
CYCLIC_TORQUE: Final = 10

TARGETS: Final = {
    CYCLIC_TORQUE: TARGET_TORQUE,
    PROFILE_TORQUE: TARGET_TORQUE,
    CYCLIC_POSITION: TARGET_POSITION,
    PROFILE_POSITION: TARGET_POSITION,
    CYCLIC_VELOCITY: TARGET_VELOCITY,
    PROFILE_VELOCITY_MODE: TARGET_VELOCITY,
}
"""The object that a mode follows."""

_NAMES: Final = {
    CYCLIC_TORQUE: "cyclic synchronous torque", PROFILE_TORQUE: "profile torque",
    CYCLIC_POSITION: "cyclic synchronous position", PROFILE_POSITION: "profile position",
    CYCLIC_VELOCITY: "cyclic synchronous velocity", PROFILE_VELOCITY_MODE: "profile velocity",
}  # fmt: skip
_CURRENT: Final = (CYCLIC_TORQUE, PROFILE_TORQUE)
_POSITION: Final = {
    "cyclic": (CYCLIC_POSITION,),
    "profile": (PROFILE_POSITION,),
    "velocity": (CYCLIC_VELOCITY, PROFILE_VELOCITY_MODE),
    "auto": (CYCLIC_POSITION, PROFILE_POSITION, CYCLIC_VELOCITY, PROFILE_VELOCITY_MODE),
}
_STEEPEST_PERMILLE_S: Final = 1_000_000  # a torque that is demanded is there within a millisecond
_PURPOSE: Final = "mode"


class ModeChoice:
    """Chooses by what the drive lists, what objects it has, and what is known of its units."""

    def __init__(self, table: ObjectTable, settings: CanopenSettings, scale: DriveScale) -> None:
        self._table = table
        self._settings = settings
        self._scale = scale
        self._listed = table.ask(SUPPORTED_MODES, _PURPOSE)
        self.lacks_rated_current = False  # a torque mode is there, and only its unit keeps it from being used

    def choose(self) -> dict[Mode, int]:
        """The code of 0x6060 for each mode of the contract that the drive can do."""
        wanted = {Mode.CURRENT: _CURRENT, Mode.POSITION: _POSITION[self._settings.position_mode]}
        found = {mode: self._first(mode, codes) for mode, codes in wanted.items()}
        return {mode: code for mode, code in found.items() if code is not None}

    def _first(self, mode: Mode, codes: tuple[int, ...]) -> int | None:
        reasons = []
        for code in codes:
            why = self._why_not(code)
            if not why:
                self._table.note(f"mode '{mode.value}'", Need.WISHED, _PURPOSE, True, f"{_NAMES[code]} ({code})")
                return code
            reasons.append(f"{_NAMES[code]} ({code}): {why}")
        self._table.note(f"mode '{mode.value}'", Need.WISHED, _PURPOSE, False, "; ".join(reasons))
        return None

    def _why_not(self, code: int) -> str:
        """Why a mode cannot be used; "" where it can."""
        # a drive that does not list its modes is asked when one is switched to
        if self._listed is not None and not self._listed >> (code - 1) & 1:
            return f"not in {SUPPORTED_MODES}"
        if not self._table.has(TARGETS[code], _PURPOSE):
            return f"{TARGETS[code]} is {self._table.outcome(TARGETS[code], _PURPOSE)}"
        if code in _CURRENT and isnan(self._scale.rated_current_a):
            self.lacks_rated_current = True
            return "what 1000 permille of torque are in A is told by neither drive nor rated_current_a"
        if code in _POSITION["velocity"] and isnan(self._scale.velocity_unit_rad_s):
            return "its unit of velocity is told by neither drive nor velocity_unit"
        if code == PROFILE_TORQUE:
            self._steepen()
        if code in (PROFILE_POSITION, PROFILE_VELOCITY_MODE):
            return self._profile(code)
        return ""

    def _steepen(self) -> None:
        """Have torque follow at once; a drive that keeps a slope is only slower."""
        slope = self._table.ask(TORQUE_SLOPE, _PURPOSE)
        if slope is not None and slope < _STEEPEST_PERMILLE_S:
            self._table.try_set(TORQUE_SLOPE, _STEEPEST_PERMILLE_S, _PURPOSE)

    def _profile(self, code: int) -> str:
        """Have speed and acceleration of a profile; why that cannot be, "" where it can."""
        settings, scale = self._settings, self._scale
        speed = [(PROFILE_VELOCITY, settings.profile_speed_rad_s, "profile_speed_rad_s", abs(scale.velocity_rad_s))]
        ramps = [
            (item, settings.profile_acceleration_rad_s2, "profile_acceleration_rad_s2", scale.acceleration_rad_s2)
            for item in (PROFILE_ACCELERATION, PROFILE_DECELERATION)
        ]
        steps = (self._set_profile(*one) for one in (speed if code == PROFILE_POSITION else []) + ramps)
        return "; ".join(filter(None, steps))

    def _set_profile(self, item: DriveObject, value: float | None, setting: str, unit: float) -> str:
        found = self._table.ask(item, _PURPOSE)
        if found is None or (found and value is None):
            return ""
        if value is None or isnan(unit):
            missing = setting if value is None else "velocity_unit"
            return f"{item} is {found}, and {missing} is not set"
        return "" if self._table.try_set(item, max(round(value / unit), 1), _PURPOSE) else f"{item} cannot be set"
