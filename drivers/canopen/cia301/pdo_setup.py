"""Which PDOs the driver uses, and putting them into the drive: written, read back, compared."""

from dataclasses import dataclass

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.objects import (
    CONTROLWORD,
    POSITION,
    STATUSWORD,
    TARGET_POSITION,
    TARGET_TORQUE,
    TORQUE_OFFSET,
    VELOCITY,
    DataType,
    DriveObject,
)
from drivers.canopen.cia301.pdo import INVALID, Pdo, PdoLayout, communication, same
from drivers.errors import DriveConfigurationError

_MOST_PDOS = 4  # of each kind that a drive has enabled by default (CiA 402)


@dataclass(frozen=True, slots=True)
class ProcessData:
    """The PDOs in use. Each demand travels with the controlword in one RPDO, so that neither comes before the other.

    Attributes:
        torque: RPDO for Mode.CURRENT.
        position: RPDO for Mode.POSITION.
        state: TPDO with statusword and what is measured of the motor.
        motion: TPDO with position and velocity.
    """

    torque: Pdo
    position: Pdo
    state: Pdo
    motion: Pdo

    def nothing(self, controlword: int) -> bytes:
        """Payload of `torque` that demands nothing."""
        return self.torque.layout.pack(controlword, *[0] * (len(self.torque.layout.entries) - 1))

    @property
    def sizes(self) -> tuple[int, ...]:
        """Bytes of the frames of a cycle: SYNC, the longer RPDO, both TPDOs."""
        demand = max(self.torque.layout.size, self.position.layout.size)
        return (0, demand, self.state.layout.size, self.motion.layout.size)


def choose_pdos(node_id: int, found: Capabilities, with_duty: bool) -> ProcessData:
    """The PDOs for what the drive has. Pure."""
    duty = found.profile.duty if with_duty else None
    state = [STATUSWORD, *(item for item in (found.current, duty) if item in found.present and item is not None)]
    motion = [POSITION, *(item for item in (VELOCITY,) if item in found.present)]
    # in both: a drive adds the offset in cyclic torque mode too, and keeps the last one it was given
    offset = [TORQUE_OFFSET] if TORQUE_OFFSET in found.present else []
    return ProcessData(
        torque=Pdo(1, False, 0x200 + node_id, PdoLayout([CONTROLWORD, TARGET_TORQUE, *offset])),
        position=Pdo(2, False, 0x300 + node_id, PdoLayout([CONTROLWORD, TARGET_POSITION, *offset])),
        state=Pdo(1, True, 0x180 + node_id, PdoLayout(state)),
        motion=Pdo(2, True, 0x280 + node_id, PdoLayout(motion)),
    )


def configure_pdos(access: ObjectAccess, device: str, data: ProcessData) -> None:
    """Configure the PDOs in use, and switch the others off: they would only load the bus.

    Raises:
        DriveConfigurationError: the drive refuses, or reads back something else.
    """
    for pdo in (data.torque, data.position, data.state, data.motion):
        for item, value in pdo.writes():
            access.write(item, value)
        for item, value in pdo.expected():
            found = access.read(item)
            if not same(item, found, value):
                raise DriveConfigurationError(
                    device,
                    f"{item} reads back as 0x{found:X}; 0x{value:X} is wanted. Is the mapping locked in the drive?",
                )
    for number in range(3, _MOST_PDOS + 1):
        for transmit in (False, True):
            _switch_off(access, communication(number, transmit, 1, DataType.U32, "COB-ID"))


def _switch_off(access: ObjectAccess, cob_id: DriveObject) -> None:
    try:
        found = access.read_if_present(cob_id)
        if found is not None and not found & INVALID:
            access.write(cob_id, found | INVALID)
    except ObjectRefusedError:
        return  # a PDO that cannot be switched off does no harm
