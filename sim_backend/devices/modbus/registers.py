"""Registers, and numbers in them."""

from dataclasses import dataclass
from enum import Enum


class Kind(Enum):
    """Type of a value: (number of registers, signed)."""

    U16 = (1, False)
    I16 = (1, True)
    U32 = (2, False)
    I32 = (2, True)

    @property
    def words(self) -> int:
        """How many registers it takes."""
        return self.value[0]

    @property
    def range(self) -> tuple[int, int]:
        """Smallest and largest value."""
        words, signed = self.value
        bits = 16 * words
        return (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)


@dataclass(frozen=True, slots=True)
class Register:
    """One value of a map.

    Attributes:
        address: of its first register.
        name: in the code.
        kind: its type.
        low, high: allowed when written; a register with None can only be read.
    """

    address: int
    name: str
    kind: Kind
    low: int | None = None
    high: int | None = None


def to_words(value: int, kind: Kind, low_word_first: bool) -> list[int]:
    """Return the registers of a value; one beyond its type becomes the nearest that is not."""
    least, most = kind.range
    raw = max(least, min(most, value)) % (1 << 16 * kind.words)
    words = [raw >> 16 & 0xFFFF, raw & 0xFFFF][-kind.words :]
    return words[::-1] if low_word_first else words


def from_words(words: list[int], kind: Kind, low_word_first: bool) -> int:
    """Return the value of its registers."""
    raw = 0
    for word in reversed(words) if low_word_first else words:
        raw = raw << 16 | word
    least, most = kind.range
    return raw - (1 << 16 * kind.words) if raw > most else max(raw, least)
