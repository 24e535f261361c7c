"""Single bits of a drive: where it tells that safe torque off (STO) is active.

CiA 402 has no object for it, so each vendor has a bit of its own. Without one, an open circuit shows as a drive that
stays in SWITCH ON DISABLED and reports no fault.
"""

from dataclasses import dataclass


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
