"""A map with values in it: reading and writing by address, by the rules of the map, and how a request is refused."""

from collections.abc import Callable, Iterable
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


class Refused(Exception):
    """Raised for a request that is answered with an exception code: 1 function, 2 address, 3 value."""

    def __init__(self, code: int) -> None:
        super().__init__(f"Modbus exception {code}")
        self.code = code


class Unanswered(Exception):
    """Raised for a request to which the device says nothing."""


ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3


class RegisterFile:
    """Registers of a map."""

    def __init__(
        self, registers: Iterable[Register], value: Callable[[str], int], low_word_first: Callable[[], bool]
    ) -> None:
        self._by_address = {register.address: register for register in registers}
        self._value = value
        self._low_word_first = low_word_first

    def read(self, address: int, count: int) -> list[int]:
        """Return words.

        Raises:
            Refused: a register is not there, or only a part of it was asked for.
        """
        words: list[int] = []
        for register in self._covered(address, count):
            words += to_words(self._value(register.name), register.kind, self._low_word_first())
        return words

    def parse(self, address: int, words: list[int]) -> dict[str, int]:
        """Return what words would write, by name.

        Raises:
            Refused: a register is not there, cannot be written, or not with such a value.
        """
        values: dict[str, int] = {}
        place = 0
        for register in self._covered(address, len(words)):
            if register.low is None or register.high is None:
                raise Refused(ILLEGAL_ADDRESS)
            own = words[place : place + register.kind.words]
            value = from_words(own, register.kind, self._low_word_first())
            if not register.low <= value <= register.high:
                raise Refused(ILLEGAL_VALUE)
            values[register.name] = value
            place += register.kind.words
        return values

    def _covered(self, address: int, count: int) -> list[Register]:
        covered, end = [], address + count
        while address < end:
            register = self._by_address.get(address)
            if register is None or address + register.kind.words > end:
                raise Refused(ILLEGAL_ADDRESS)
            covered.append(register)
            address += register.kind.words
        return covered
