"""Finding room for PDOs in a drive, and configuring them: read first, written where they differ, read back."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.objects import DataType, DriveObject
from drivers.canopen.cia301.pdo import (
    INVALID,
    RECEIVED,
    Pdo,
    Write,
    cob_id_entry,
    communication,
    is_mapping,
    is_type_of_rpdo,
    mapping_entry,
    same,
)
from drivers.errors import DriveConfigurationError

MOST_PDOS: Final = 8  # of each kind that CiA 402 has a default for
_INHIBIT_TIME, _EVENT_TIMER = 3, 5  # subindices of a TPDO's communication record


@dataclass(frozen=True, slots=True)
class Slot:
    """One PDO of the drive as it was found."""

    number: int
    transmit: bool
    cob_id: int
    mapped: tuple[int, ...]


def read_slots(access: ObjectAccess, transmit: bool) -> list[Slot]:
    """The PDOs that the drive has, of one direction."""
    found = (_read_slot(access, number, transmit) for number in range(1, MOST_PDOS + 1))
    return [slot for slot in found if slot is not None]


def _read_slot(access: ObjectAccess, number: int, transmit: bool) -> Slot | None:
    cob_id = access.read_if_present(cob_id_entry(number, transmit))
    count = None if cob_id is None else access.read_if_present(mapping_entry(number, transmit, 0))
    if cob_id is None or count is None:
        return None
    words = (access.read_if_present(mapping_entry(number, transmit, place)) for place in range(1, count + 1))
    return Slot(number, transmit, cob_id, tuple(word or 0 for word in words))


def configure(access: ObjectAccess, device: str, pdo: Pdo, slot: Slot) -> None:
    """Have one PDO as it is wanted.

    Raises:
        DriveConfigurationError: the drive refuses, or reads back something else.
    """
    wanted = pdo.expected()
    if all(same(item, access.read(item), value) for item, value in wanted):
        return
    _write(access, pdo, is_enabled=same(wanted[0].object, slot.cob_id, wanted[0].value))
    _check(access, device, wanted)


def _write(access: ObjectAccess, pdo: Pdo, is_enabled: bool) -> None:
    """Write what differs now: a trial before may have emptied a mapping, or changed it."""
    cob_id = cob_id_entry(pdo.number, pdo.transmit)
    mapped = all(access.read_if_present(item) == value for item, value in pdo.expected() if is_mapping(item))
    for item, value in pdo.writes(with_mapping=not mapped):
        if is_mapping(item) and access.read_if_present(item) == value:
            continue  # one that cannot be written may be right already
        try:
            access.write(item, value)
        except ObjectRefusedError:
            # one that cannot be switched off may be mapped all the same; what reads back tells whether a type will do
            if not (item == cob_id and is_enabled) and not is_type_of_rpdo(item):
                raise


def _check(access: ObjectAccess, device: str, wanted: Sequence[Write]) -> None:
    for item, value in wanted:
        found = access.read(item)
        if not same(item, found, value) and not (is_type_of_rpdo(item) and found in RECEIVED):
            raise DriveConfigurationError(
                device, f"{item} reads back as 0x{found:X}; 0x{value:X} is wanted. Is the mapping locked in the drive?"
            )


def release(access: ObjectAccess, pdos: Sequence[Pdo]) -> None:
    """Take timers off the TPDOs in use, and switch every other PDO off: it would only load the bus."""
    used = {(pdo.number, pdo.transmit) for pdo in pdos}
    for pdo in pdos:
        for subindex in (_INHIBIT_TIME, _EVENT_TIMER) if pdo.transmit else ():
            _zero(access, communication(pdo.number, True, subindex, DataType.U16, "timer"))
    for number in range(1, MOST_PDOS + 1):
        for transmit in (False, True):
            if (number, transmit) not in used:
                switch_off(access, number, transmit)


def _zero(access: ObjectAccess, item: DriveObject) -> None:
    try:
        if access.read_if_present(item):
            access.write(item, 0)
    except ObjectRefusedError:
        return  # the drive minds it for events alone; at SYNC it is not to matter


def switch_off(access: ObjectAccess, number: int, transmit: bool) -> None:
    """Have a PDO not exist, where the drive lets that be set."""
    cob_id = cob_id_entry(number, transmit)
    try:
        found = access.read_if_present(cob_id)
        if found is not None and not found & INVALID:
            access.write(cob_id, found | INVALID)
    except ObjectRefusedError:
        return  # a PDO that cannot be switched off does no harm
