"""One quantity in one or two registers, or in a single bit: words to SI and back."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import isfinite
from struct import Struct, pack

WORD_BITS = 16


class Space(Enum):
    """Which of the four tables: two of 16-bit registers, two of single bits."""

    INPUT = "input"  # read only, function 4
    HOLDING = "holding"  # functions 3, 6, 16, 23
    DISCRETE = "discrete"  # bits, read only, function 2
    COIL = "coil"  # bits, functions 1, 5, 15

    @property
    def is_bits(self) -> bool:
        """Whether its addresses are of single bits; a bit counts as a word of 0 or 1 here."""
        return self in (Space.DISCRETE, Space.COIL)

    @property
    def is_writable(self) -> bool:
        """Whether a host may write there."""
        return self in (Space.HOLDING, Space.COIL)


class Number(Enum):
    """How a quantity is kept. The value is the layout, most significant byte first."""

    UINT16 = ">H"
    INT16 = ">h"
    UINT32 = ">I"
    INT32 = ">i"
    FLOAT32 = ">f"
    LOW_INT16 = ">xxh"  # two words of which the more significant one is without meaning
    LOW_UINT16 = ">xxH"
    BIT = ">1H"  # a coil or a discrete input

    layout: Struct
    words: int  # registers that it takes
    bounds: tuple[float, float] | None  # smallest and largest whole number; None for floats

    def __init__(self, layout: str) -> None:
        self.layout = Struct(layout)
        self.words = self.layout.size * 8 // WORD_BITS
        bits, kind = 16 if "x" in layout else self.layout.size * 8, layout[-1]
        signed = kind.islower()
        whole = (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if signed else (0, 2**bits - 1)
        whole = (0, 1) if "1" in layout else whole
        self.bounds = None if kind == "f" else whole


@dataclass(frozen=True, slots=True)
class Register:
    """One quantity as the drive keeps it.

    Attributes:
        name: unique in its map.
        space: the table that it lies in.
        address: of its first word, counted from 0, as on the wire.
        number: how it is kept.
        unit: of the scaled value; "" for codes and bit fields.
        scale: scaled value of one step.
        offset: scaled value of the number 0.
        low_word_first: where the less significant of two words has the lower address.
        low_byte_first: where the less significant byte of each word comes first.
    """

    name: str
    space: Space
    address: int
    number: Number
    unit: str = ""
    scale: float = 1.0
    offset: float = 0.0
    low_word_first: bool = False
    low_byte_first: bool = False

    @property
    def is_plain(self) -> bool:
        """Whether its bytes lie as the standard has them, the most significant first."""
        return not self.low_byte_first and (self.number.words == 1 or not self.low_word_first)

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
        return self.decode_bytes(as_bytes(words), 0)

    def decode_bytes(self, data: bytes, start: int) -> float:
        """The scaled value of its words, which begin at a place in the bytes of some."""
        if not self.is_plain:
            data, start = self._ordered(data[start : start + 2 * self.words]), 0
        return float(self.number.layout.unpack_from(data, start)[0]) * self.scale + self.offset

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
        data = self.number.layout.pack(steps)
        data = data if self.is_plain else self._ordered(data)
        return [data[place] << 8 | data[place + 1] for place in range(0, len(data), 2)]

    def _ordered(self, data: bytes) -> bytes:
        """From the standard's order of bytes to the drive's, or back."""
        words = [data[place : place + 2] for place in range(0, len(data), 2)]
        words = words[::-1] if self.low_word_first else words
        return b"".join(word[::-1] for word in words) if self.low_byte_first else b"".join(words)


@dataclass(frozen=True, slots=True)
class Text:
    """Words as characters, two to a word, the first in the high byte; filled up with zeros."""

    name: str
    space: Space
    address: int
    words: int

    def decode(self, words: Sequence[int]) -> str:
        """The characters."""
        return as_bytes(words).rstrip(b"\0").decode("ascii", "replace").strip()


def as_bytes(words: Sequence[int]) -> bytes:
    """Words as bytes, the more significant byte of each first."""
    return pack(f">{len(words)}H", *words)
