"""Single bits of a drive: where it tells that safe torque off (STO) is active, and the output of a holding brake.

CiA 402 has no object for safe torque off, so each vendor has a bit of its own; without one, an open circuit shows as a
drive that stays in SWITCH ON DISABLED and reports no fault. A brake is bit 0 of 0x60FE ('set brake', CiA 402-2), or
whichever output it is wired to.
"""

import struct
from dataclasses import dataclass
from typing import Final, Literal

from drivers.canopen.cia301.objects import DataType, DriveObject
from drivers.settings import Settings, quantity

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


class TorqueOffSettings(Settings):
    """One bit of an object of the drive, by its manual."""

    index: int = quantity(..., "", "Index of the object; 0x60FD are the digital inputs", ge=0x1000, le=0xFFFF)
    subindex: int = quantity(0, "", "Its subindex", ge=0, le=255)
    bit: int = quantity(..., "", "Number of the bit, from 0", ge=0, le=31)
    level: Literal[0, 1] = quantity(1, "", "The bit while safe torque off is active")

    def holds(self, value: int) -> bool:
        """Whether a value of the object says that it is active."""
        return value >> self.bit & 1 == self.level

    def seen(self, value: int) -> str:
        """What a value of the object shows, in words."""
        return f"{self} is {value >> self.bit & 1}"

    def __str__(self) -> str:
        return f"bit {self.bit} of 0x{self.index:04X}:{self.subindex:02X}"
