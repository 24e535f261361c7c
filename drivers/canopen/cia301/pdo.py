"""Process data objects: their layout, and the writes that configure them (CiA 301, 7.5.2.35 to 7.5.2.38). Pure."""

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from drivers.canopen.cia301.objects import DataType, DriveObject

SYNCHRONOUS = 1  # transmission type: at every SYNC
# with which an RPDO is taken: at the next SYNC (0 .. 240), or as it comes (254, 255); the others are reserved
RECEIVED = frozenset((*range(241), 254, 255))
INVALID = 0x8000_0000  # bit 31 of a PDO's COB-ID: it does not exist
NO_RTR = 0x4000_0000  # bit 30 of a TPDO's COB-ID: it cannot be requested
_LONGEST = 8  # bytes of a CAN frame


class Write(NamedTuple):
    """One value for one object."""

    object: DriveObject
    value: int


class PdoLayout:
    """Objects one after the other in up to 8 bytes, little-endian.

    Raises:
        ValueError: they do not fit.
    """

    def __init__(self, entries: Sequence[DriveObject]) -> None:
        self.entries = tuple(entries)
        self._struct = struct.Struct("<" + "".join(entry.type.value for entry in entries))
        self.size = self._struct.size
        if self.size > _LONGEST:
            raise ValueError(f"{self.size} bytes do not fit a PDO of {_LONGEST}")
        self.pack = self._struct.pack
        self.unpack = self._struct.unpack


@dataclass(frozen=True, slots=True)
class Pdo:
    """One PDO of the drive."""

    number: int
    transmit: bool
    cob_id: int
    layout: PdoLayout

    def writes(self, with_mapping: bool = True) -> list[Write]:
        """How it is configured: off, transmission type, no entries, the entries, their number, on.

        Args:
            with_mapping: False where the mapping is as wanted already; it may be one that cannot be written.
        """
        which = self.number, self.transmit
        cob_id, count = cob_id_entry(*which), mapping_entry(*which, 0)
        flags = NO_RTR if self.transmit else 0
        entries = [Write(mapping_entry(*which, place), one.mapping) for place, one in enumerate(self.layout.entries, 1)]
        return [
            Write(cob_id, INVALID | flags | self.cob_id),
            Write(communication(*which, 2, DataType.U8, "transmission type"), SYNCHRONOUS),
            *([Write(count, 0), *entries, Write(count, len(entries))] if with_mapping else []),
            Write(cob_id, flags | self.cob_id),
        ]

    def expected(self) -> list[Write]:
        """What reads back afterwards: the last value written to each object."""
        return [Write(item, value) for item, value in dict(self.writes()).items()]

    def __str__(self) -> str:
        return f"{'TPDO' if self.transmit else 'RPDO'}{self.number}"


def communication(number: int, transmit: bool, subindex: int, kind: DataType, name: str) -> DriveObject:
    """An entry of a PDO's communication record."""
    index = (0x1800 if transmit else 0x1400) + number - 1
    return DriveObject(index, subindex, kind, f"{name} of {'TPDO' if transmit else 'RPDO'}{number}")


def cob_id_entry(number: int, transmit: bool) -> DriveObject:
    """The entry of a PDO's COB-ID."""
    return communication(number, transmit, 1, DataType.U32, "COB-ID")


def mapping_entry(number: int, transmit: bool, subindex: int) -> DriveObject:
    """An entry of a PDO's mapping record."""
    kind = DataType.U32 if subindex else DataType.U8
    index = (0x1A00 if transmit else 0x1600) + number - 1
    return DriveObject(index, subindex, kind, f"mapping of {'TPDO' if transmit else 'RPDO'}{number}")


def is_mapping(item: DriveObject) -> bool:
    """Whether an object is of a PDO's mapping record."""
    return 0x1600 <= item.index < 0x1800 or 0x1A00 <= item.index < 0x1C00


def is_type_of_rpdo(item: DriveObject) -> bool:
    """Whether an object is the transmission type of an RPDO."""
    return 0x1400 <= item.index < 0x1600 and item.subindex == 2


def same(item: DriveObject, found: int, wanted: int) -> bool:
    """Whether what reads back is what was written. Bit 30 of a COB-ID is the device's own business."""
    if item.subindex == 1 and (0x1400 <= item.index < 0x1600 or 0x1800 <= item.index < 0x1A00):
        return found & ~NO_RTR == wanted & ~NO_RTR
    return found == wanted
