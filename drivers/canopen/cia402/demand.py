"""From a command of the contract to the RPDO that carries it. Pure."""

from typing import Final

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.objects import CONTROLWORD, TORQUE_OFFSET, DriveObject
from drivers.canopen.cia301.pdo import Pdo
from drivers.canopen.cia402.modes import PROFILE_POSITION, TARGETS
from drivers.canopen.cia402.process_data import ProcessData, rest_payload
from drivers.canopen.cia402.state_machine import ENABLE_OPERATION
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError
from drivers.refusal import check_demand

_NEW_SET_POINT = 0x10
_CHANGE_IMMEDIATELY = 0x20
_ACKNOWLEDGED = 0x1000  # statusword bit 12
_APPROACH_1_S: Final = 10.0  # speed for a position error, where this host closes the position [1/s]
_SLOWEST_RAD_S: Final = 2.0  # highest joint speed of that, where the settings name none


class SetPointHandshake:
    """Gives each target to the drive once (CiA 402-2, 10.3).

    A target stays as it is until the drive has acknowledged it; then bit 4 has to fall before the next one counts.
    """

    def __init__(self, target: int) -> None:
        self._target = target
        self._offered = False

    def step(self, wanted: int, statusword: int) -> tuple[int, int]:
        """Controlword and target of the next cycle."""
        acknowledged = bool(statusword & _ACKNOWLEDGED)
        if self._offered:
            self._offered = not acknowledged
        elif not acknowledged and wanted != self._target:
            self._target = wanted
            self._offered = True
        bits = _NEW_SET_POINT | _CHANGE_IMMEDIATELY if self._offered else 0
        return ENABLE_OPERATION | bits, self._target


class Demand:
    """Demands in one mode, from switching on to switching off."""

    def __init__(
        self, settings: CanopenSettings, found: Capabilities, data: ProcessData, mode: Mode, position_counts: int
    ) -> None:
        self._device = settings.device
        self._found = found
        self._mode = mode
        self.code = found.modes[mode]
        target = TARGETS[self.code]
        self.pdo: Pdo = data.demands[target]
        self._speed_rad_s = settings.profile_speed_rad_s or _SLOWEST_RAD_S
        self._is_position = mode is Mode.POSITION
        self._by_velocity = self._is_position and self.code not in (8, 1)
        self._handshake = SetPointHandshake(position_counts) if self.code == PROFILE_POSITION else None
        self._place_values(target)

    def _place_values(self, target: DriveObject) -> None:
        """Where controlword, target and offset are in the RPDO."""
        entries = self.pdo.layout.entries
        self._values = list(self.pdo.layout.unpack(rest_payload(self.pdo.layout, 0, 0, self.code)))
        self._word_at, self._target_at = entries.index(CONTROLWORD), entries.index(target)
        self._offset_at = entries.index(TORQUE_OFFSET) if TORQUE_OFFSET in entries else None

    def at_rest(self, controlword: int, position_counts: int) -> bytes:
        """Payload that asks for nothing: no torque, no speed, or the position where the drive stands."""
        return rest_payload(self.pdo.layout, controlword, position_counts, self.code)

    def payload(self, command: Command, statusword: int, position_counts: int) -> bytes:
        """Payload of a command in operation.

        Raises:
            DriveConfigurationError: a value is not finite, or does not fit its object; nothing may be sent.
        """
        scale = self._found.scale
        if not self._is_position:
            check_demand(self._device, self._mode, command.value, scale.highest_current_a, "A")
            return self._pack(ENABLE_OPERATION, scale.torque_permille(command.value), 0)
        check_demand(self._device, self._mode, command.value, scale.farthest_rad, "rad")
        offset = self._offset(command.feed_forward_a)
        if self._by_velocity:
            return self._pack(ENABLE_OPERATION, self._towards(command.value, position_counts), offset)
        controlword, target = ENABLE_OPERATION, scale.joint.counts(command.value)
        if self._handshake is not None:
            controlword, target = self._handshake.step(target, statusword)
        return self._pack(controlword, target, offset)

    def _offset(self, offset_a: float) -> int:
        """Feed-forward current as torque offset."""
        if offset_a == 0.0:
            return 0
        if self._offset_at is None:
            raise DriveConfigurationError(
                self._device,
                f"feed-forward current is {offset_a:g} A; 0 is allowed, for the drive has no {TORQUE_OFFSET}",
            )
        check_demand(self._device, Mode.CURRENT, offset_a, self._found.scale.highest_current_a, "A")
        return self._found.scale.torque_permille(offset_a)

    def _towards(self, target_rad: float, position_counts: int) -> int:
        """Speed demand [counts] that takes the joint to a position."""
        error_rad = target_rad - self._found.scale.joint.position_rad(position_counts)
        speed_rad_s = max(-self._speed_rad_s, min(self._speed_rad_s, _APPROACH_1_S * error_rad))
        return self._found.scale.velocity_counts(speed_rad_s)

    def _pack(self, controlword: int, target: int, offset: int) -> bytes:
        values = self._values
        values[self._word_at], values[self._target_at] = controlword, target
        if self._offset_at is not None:
            values[self._offset_at] = offset
        return self.pdo.layout.pack(*values)
