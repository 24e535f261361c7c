"""From a command of the contract to the RPDO that carries it. Pure."""

from drivers.canopen.capabilities import PROFILE_POSITION, Capabilities
from drivers.canopen.cia301.objects import TORQUE_OFFSET
from drivers.canopen.cia301.pdo import Pdo
from drivers.canopen.cia301.pdo_setup import ProcessData
from drivers.canopen.cia402.set_point import SetPointHandshake
from drivers.canopen.cia402.state_machine import ENABLE_OPERATION
from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError
from drivers.refusal import check_demand


class Demand:
    """Demands in one mode, from switching on to switching off.

    Args:
        device: named in errors.
        found: scales and objects of the drive.
        data: its PDOs.
        mode: CURRENT or POSITION.
        position_counts: where the drive stands now.
    """

    def __init__(self, device: str, found: Capabilities, data: ProcessData, mode: Mode, position_counts: int) -> None:
        self._device = device
        self._found = found
        self._mode = mode
        self.pdo: Pdo = data.torque if mode is Mode.CURRENT else data.position
        self._has_offset = TORQUE_OFFSET in self.pdo.layout.entries
        self._position_counts = position_counts
        profile_position = mode is Mode.POSITION and found.modes[mode] == PROFILE_POSITION
        self._handshake = SetPointHandshake(position_counts) if profile_position else None

    def at_rest(self, controlword: int, position_counts: int) -> bytes:
        """Payload that asks for nothing: no torque, or the position where the drive stands."""
        target = 0 if self._mode is Mode.CURRENT else position_counts
        return self._pack(controlword, target, 0)

    def payload(self, command: Command, statusword: int) -> bytes:
        """Payload of a command in operation.

        Args:
            command: in this mode.
            statusword: as last received.

        Raises:
            DriveConfigurationError: a value is not finite, or does not fit its object; nothing may be sent.
        """
        scale, offset_a = self._found.scale, command.feed_forward_a
        if self._mode is Mode.CURRENT:
            check_demand(self._device, self._mode, command.value, scale.highest_current_a, "A")
            return self._pack(ENABLE_OPERATION, scale.torque_permille(command.value), 0)
        check_demand(self._device, self._mode, command.value, scale.farthest_rad, "rad")
        check_demand(self._device, Mode.CURRENT, offset_a, scale.highest_current_a, "A")
        if offset_a and not self._has_offset:
            raise DriveConfigurationError(
                self._device,
                f"feed-forward current is {offset_a:g} A; 0 is allowed, for the drive has no {TORQUE_OFFSET}",
            )
        controlword, target = ENABLE_OPERATION, scale.joint.counts(command.value)
        if self._handshake is not None:
            controlword, target = self._handshake.step(target, statusword)
        return self._pack(controlword, target, scale.torque_permille(offset_a))

    def _pack(self, controlword: int, target: int, offset: int) -> bytes:
        values = (controlword, target, offset) if self._has_offset else (controlword, target)
        return self.pdo.layout.pack(*values)
