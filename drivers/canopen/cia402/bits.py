"""Single bits of a drive: where it tells that safe torque off (STO) is active, and the output of a holding brake.

CiA 402 has no object for safe torque off, so each vendor has a bit of its own; without one, an open circuit shows as a
drive that stays in SWITCH ON DISABLED and reports no fault. A brake is bit 0 of 0x60FE ('set brake', CiA 402-2), or
whichever output it is wired to.
"""

import struct
from dataclasses import dataclass
from typing import Final

from drivers.canopen.cia301.objects import DataType, DriveObject

OUTPUTS: Final = DriveObject(0x60FE, 1, DataType.U32, "physical outputs")
OUTPUT_MASK: Final = DriveObject(0x60FE, 2, DataType.U32, "bit mask of the outputs")  # many drives have none
_DOWNLOAD_4: Final = 0x23  # SDO: expedited download of four bytes (CiA 301, 7.2.4.3)


@dataclass(frozen=True, slots=True)
class BrakeBit:
    """Which output it is.

    Attributes:
        bit: of 0x60FE.
        set_level: of the bit while the brake is set.
    """

    bit: int = 0
    set_level: int = 1

    @property
    def mask(self) -> int:
        """Of the bit."""
        return 1 << self.bit

    def word(self, outputs: int, released: bool) -> int:
        """The outputs with the brake set or released, the others as they are."""
        return outputs | self.mask if released != bool(self.set_level) else outputs & ~self.mask


def download(outputs: int) -> bytes:
    """The SDO request that writes the outputs, for whoever cannot wait for its answer."""
    return struct.pack("<BHBI", _DOWNLOAD_4, OUTPUTS.index, OUTPUTS.subindex, outputs)


@dataclass(frozen=True, slots=True)
class TorqueOffBit:
    """One bit of an object.

    Attributes:
        index, subindex: of the object; 0x60FD are the digital inputs.
        bit: counted from 0.
        level: of the bit while safe torque off is active.
    """

    index: int
    subindex: int = 0
    bit: int = 0
    level: int = 1

    @property
    def is_possible(self) -> bool:
        """Whether there can be such a bit."""
        place = 0x1000 <= self.index <= 0xFFFF and 0 <= self.subindex <= 0xFF
        return place and 0 <= self.bit <= 31 and self.level in (0, 1)

    def holds(self, value: int) -> bool:
        """Whether a value of the object says that it is active."""
        return value >> self.bit & 1 == self.level

    def seen(self, value: int) -> str:
        """What a value of the object shows, in words."""
        return f"{self} is {value >> self.bit & 1}"

    def __str__(self) -> str:
        return f"bit {self.bit} of 0x{self.index:04X}:{self.subindex:02X}"
