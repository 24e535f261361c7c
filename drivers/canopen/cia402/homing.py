"""The drive's own homing (CiA 402-2, mode 6): what it needs, and what comes of it, by its statusword."""

from dataclasses import dataclass
from typing import Final

from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import (
    HOME_OFFSET,
    HOMING_ACCELERATION,
    HOMING_METHOD,
    HOMING_SPEED_SWITCH,
    HOMING_SPEED_ZERO,
    SUPPORTED_MODES,
    VELOCITY,
)
from drivers.canopen.cia402.process_data import ProcessData, rest_payload
from drivers.canopen.cia402.scale import DriveScale
from drivers.canopen.cia402.state_machine import ENABLE_OPERATION
from drivers.contract import Command

HOMING_MODE: Final = 6
_START: Final = 0x10  # controlword bit 4: begin, or go on
_ATTAINED, _ERROR = 1 << 12, 1 << 13  # of the statusword
_STALE_CYCLES: Final = 50  # in which a bit may still be that of a homing before
_PURPOSE: Final = "homing"


@dataclass(frozen=True, slots=True)
class DriveHoming:
    """How the drive is to home.

    Attributes:
        method: number for 0x6098, by the drive's manual; those of the standard are above 0.
        speed_rad_s: of the joint, towards a switch or a stop.
        slow_speed_rad_s: towards the index pulse, or the edge of the switch.
        acceleration_rad_s2: of the joint.
    """

    method: int
    speed_rad_s: float
    slow_speed_rad_s: float
    acceleration_rad_s2: float


def why_not(table: ObjectTable, scale: DriveScale, has_velocity: bool) -> str:
    """Why the drive cannot home as this driver has it; "" where it can. Nothing is written.

    Args:
        table: of its objects.
        scale: of drive and joint.
        has_velocity: whether it tells its speed: its position begins anew, and tells none meanwhile.
    """
    listed = table.ask(SUPPORTED_MODES, _PURPOSE)
    missing = [
        f"no {item}"
        for item in (HOMING_METHOD, HOMING_SPEED_SWITCH, HOMING_SPEED_ZERO, HOMING_ACCELERATION)
        if not table.has(item, _PURPOSE)
    ]
    if listed is not None and not listed >> (HOMING_MODE - 1) & 1:
        missing.append(f"homing ({HOMING_MODE}) is not in {SUPPORTED_MODES}")
    if not has_velocity:
        missing.append(f"no {VELOCITY}")
    elif scale.velocity_rad_s != scale.velocity_rad_s:  # NaN
        missing.append("its unit of velocity is told by neither drive nor velocity_unit: set drive.velocity_unit")
    table.note("mode 'home'", Need.WISHED, _PURPOSE, not missing, "; ".join(missing) or f"homing ({HOMING_MODE})")
    return "; ".join(missing)


def set_up(table: ObjectTable, scale: DriveScale, homing: DriveHoming) -> None:
    """Tell the drive how; its home position is to be 0, whatever was set before.

    Raises:
        DriveConfigurationError: it refuses a value, above all a method that it does not have.
    """
    speed_unit = abs(scale.velocity_rad_s)
    table.set(HOMING_METHOD, homing.method, _PURPOSE)
    for item, value, unit in (
        (HOMING_SPEED_SWITCH, homing.speed_rad_s, speed_unit),
        (HOMING_SPEED_ZERO, homing.slow_speed_rad_s, speed_unit),
        (HOMING_ACCELERATION, homing.acceleration_rad_s2, scale.acceleration_rad_s2),
    ):
        table.set(item, max(round(value / unit), 1), _PURPOSE)
    # drives differ in whether home is the offset, or minus it
    if table.ask(HOME_OFFSET, _PURPOSE):
        table.set(HOME_OFFSET, 0, _PURPOSE)


class HomingDemand:
    """Starts the homing, and looks what becomes of it.

    A drive that has homed before may show that until the new homing is under way: a bit counts once it was seen low,
    or stands for long.

    Attributes:
        code: of 0x6060.
    """

    code = HOMING_MODE

    def __init__(self, data: ProcessData) -> None:
        self.pdo = data.idle
        self._cycles = 0
        self._fresh = 0  # bits that were seen low since the power came

    def at_rest(self, controlword: int, position_counts: int) -> bytes:
        """Payload that does not start it."""
        return rest_payload(self.pdo.layout, controlword, position_counts, self.code)

    def payload(self, command: Command, statusword: int, position_counts: int) -> bytes:
        """Payload that starts it, or lets it go on; with a value of 0, one that breaks it off."""
        self._fresh |= ~statusword & (_ATTAINED | _ERROR)
        if command.value != 1.0:
            return self.at_rest(ENABLE_OPERATION, position_counts)
        self._cycles += 1
        return self.at_rest(ENABLE_OPERATION | _START, position_counts)

    def attained(self, statusword: int) -> bool:
        """Whether home is found, by a statusword that answers `payload`."""
        return self._counts(statusword, _ATTAINED) and not statusword & _ERROR

    def failed(self, statusword: int) -> bool:
        """Whether the drive has given up."""
        return self._counts(statusword, _ERROR)

    def _counts(self, statusword: int, bit: int) -> bool:
        # the answer to the first start was measured before it
        return bool(statusword & bit) and self._cycles > 1 and bool(self._fresh & bit or self._cycles > _STALE_CYCLES)
