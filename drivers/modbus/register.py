"""One quantity in one or two registers: words to SI and back."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import isfinite
from struct import Struct

WORD_BITS = 16


class Space(Enum):
    """Which of the two tables of 16-bit registers."""

    INPUT = "input"  # read only, function 4
    HOLDING = "holding"  # functions 3, 6, 16, 23


class Number(Enum):
    """How a quantity is kept. The value is the layout, most significant byte first."""

    UINT16 = ">H"
    INT16 = ">h"
    UINT32 = ">I"
    INT32 = ">i"
    FLOAT32 = ">f"
    LOW_INT16 = ">xxh"  # two words of which the more significant one is without meaning
    LOW_UINT16 = ">xxH"

    @property
    def words(self) -> int:
        """Registers that it takes."""
        return Struct(self.value).size * 8 // WORD_BITS

    @property
    def bounds(self) -> tuple[float, float] | None:
        """Smallest and largest whole number; None for floats."""
        if self is Number.FLOAT32:
            return None
        bits = int(self.name[-2:])
        return (0, 2**bits - 1) if "UINT" in self.name else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


@dataclass(frozen=True, slots=True)
class Register:
    """One quantity as the drive keeps it.

    Attributes:
        name: unique in its map.
        space: input or holding.
        address: of its first word, counted from 0, as on the wire.
        number: how it is kept.
        unit: of the scaled value; "" for codes and bit fields.
        scale: scaled value of one step.
        offset: scaled value of the number 0.
        low_word_first: where the less significant of two words has the lower address.
    """

    name: str
    space: Space
    address: int
    number: Number
    unit: str = ""
    scale: float = 1.0
    offset: float = 0.0
    low_word_first: bool = False

    @property
    def words(self) -> int:
        """Registers that it takes."""
        return self.number.words

    @property
    def end(self) -> int:
        """The first address after it."""
        return self.address + self.words

    def decode(self, words: Sequence[int]) -> float:
        """The scaled value of its words."""
        ordered = reversed(words) if self.low_word_first else words
        data = b"".join(word.to_bytes(2, "big") for word in ordered)
        return float(Struct(self.number.value).unpack(data)[0]) * self.scale + self.offset

    def encode(self, value: float) -> list[int]:
        """The words of a scaled value.

        Raises:
            ValueError: not finite, or outside what the number holds; in scaled units.
        """
        steps = (value - self.offset) / self.scale
        if not isfinite(steps):
            raise ValueError(f"{self.name} is {value}; a finite number is wanted")
        bounds = self.number.bounds
        if bounds is not None:
            steps = round(steps)
            if not bounds[0] <= steps <= bounds[1]:
                low, high = (bound * self.scale + self.offset for bound in bounds)
                raise ValueError(f"{self.name} is {value:g} {self.unit}; its register holds {low:g} .. {high:g}")
        data = Struct(self.number.value).pack(steps)
        words = [int.from_bytes(data[place : place + 2], "big") for place in range(0, len(data), 2)]
        return words[::-1] if self.low_word_first else words


@dataclass(frozen=True, slots=True)
class Text:
    """Words as characters, two to a word, the first in the high byte; filled up with zeros.

    Attributes:
        name, space, address: as of a register.
        words: how many.
    """

    name: str
    space: Space
    address: int
    words: int

    def decode(self, words: Sequence[int]) -> str:
        """The characters."""
        data = b"".join(word.to_bytes(2, "big") for word in words)
        return data.rstrip(b"\0").decode("ascii", "replace").strip()
