"""A map with values in it: reading and writing by address, by the rules of the map, and how a request is refused."""

from collections.abc import Callable, Iterable

from sim_backend.devices.modbus.registers import Register, from_words, to_words


class Refused(Exception):
    """Raised for a request that is answered with an exception code: 1 function, 2 address, 3 value."""

    def __init__(self, code: int) -> None:
        super().__init__(f"Modbus exception {code}")
        self.code = code


class Unanswered(Exception):
    """Raised for a request to which the device says nothing."""


ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3


class RegisterFile:
    """Registers of a map.

    Args:
        registers: the map.
        value: returns what a register says now, by its name.
        low_word_first: tells the word order.
    """

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
