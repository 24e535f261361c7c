"""What the bits of the status word mean (command 90), in both layouts of the manual."""

from typing import NamedTuple


class Flag(NamedTuple):
    """One bit.

    Attributes:
        mask: of the bit.
        name: as the manual has it.
        motor: 1 or 2; 0 where it concerns both.
        is_fault: False for a warning: the motors go on.
    """

    mask: int
    name: str
    motor: int = 0
    is_fault: bool = True


FLAGS_32_BIT = (
    Flag(0x0000_0001, "E-stop"),
    Flag(0x0000_0002, "temperature error"),
    Flag(0x0000_0004, "temperature 2 error"),
    Flag(0x0000_0008, "main voltage too high"),
    Flag(0x0000_0010, "logic voltage too high"),
    Flag(0x0000_0020, "logic voltage too low"),
    Flag(0x0000_0040, "M1 driver fault", 1),
    Flag(0x0000_0080, "M2 driver fault", 2),
    Flag(0x0000_0100, "M1 speed error", 1),
    Flag(0x0000_0200, "M2 speed error", 2),
    Flag(0x0000_0400, "M1 position error", 1),
    Flag(0x0000_0800, "M2 position error", 2),
    Flag(0x0000_1000, "M1 current error", 1),
    Flag(0x0000_2000, "M2 current error", 2),
    Flag(0x0001_0000, "M1 over-current warning", 1, is_fault=False),
    Flag(0x0002_0000, "M2 over-current warning", 2, is_fault=False),
    Flag(0x0004_0000, "main voltage high warning", is_fault=False),
    Flag(0x0008_0000, "main voltage low warning"),  # command 2: below its minimum the motors are not driven
    Flag(0x0010_0000, "temperature warning", is_fault=False),
    Flag(0x0020_0000, "temperature 2 warning", is_fault=False),
)
FLAGS_16_BIT = (
    Flag(0x0001, "M1 over-current warning", 1, is_fault=False),
    Flag(0x0002, "M2 over-current warning", 2, is_fault=False),
    Flag(0x0004, "E-stop"),
    Flag(0x0008, "temperature error"),
    Flag(0x0010, "temperature 2 error"),
    Flag(0x0020, "main voltage too high"),
    Flag(0x0040, "logic voltage too high"),
    Flag(0x0080, "logic voltage too low"),
    Flag(0x0100, "M1 driver fault", 1),
    Flag(0x0200, "M2 driver fault", 2),
    Flag(0x0400, "main voltage high warning", is_fault=False),
    Flag(0x0800, "main voltage low warning"),
    Flag(0x1000, "temperature warning", is_fault=False),
    Flag(0x2000, "temperature 2 warning", is_fault=False),
)


def faults(word: int, flags: tuple[Flag, ...], motor: int) -> list[str]:
    """Names of the faults in a status word that stop one motor.

    Args:
        word: as answered.
        flags: `FLAGS_32_BIT` where the answer has four bytes, `FLAGS_16_BIT` where it has two.
        motor: 1 or 2.
    """
    return [flag.name for flag in flags if word & flag.mask and flag.is_fault and flag.motor in (0, motor)]
