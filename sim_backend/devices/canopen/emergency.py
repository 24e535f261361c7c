"""Emergency messages, the error register (0x1001) and the history of errors (0x1003)."""

from enum import IntEnum
from struct import pack

from sim_backend.devices.canopen.abort import only
from sim_backend.devices.canopen.dictionary import Dictionary

NO_ERROR = 0x0000


class ErrorCode(IntEnum):
    """Error codes of CiA 301 and CiA 402 that this drive knows."""

    GENERIC = 0x1000
    OVER_CURRENT = 0x2310
    UNDER_VOLTAGE = 0x3220
    OVER_TEMPERATURE = 0x4210
    HEARTBEAT = 0x8130
    PDO_TOO_SHORT = 0x8210
    PDO_TOO_LONG = 0x8220
    RPDO_TIMEOUT = 0x8250
    FOLLOWING_ERROR = 0x8611


# bits of 0x1001, by the first digits of the code; bit 0 is set with any error
_REGISTER = ((0x8600, 0x20), (0x8000, 0x10), (0x4000, 0x08), (0x3000, 0x04), (0x2000, 0x02))


def register_bits(code: int) -> int:
    """Return the bits of the error register for an error."""
    for first, bit in _REGISTER:
        mask = 0xFF00 if first & 0x0F00 else 0xF000
        if code & mask == first:
            return 0x01 | bit
    return 0x01


class Emergency:
    """Keeps the errors that are there, and makes the messages."""

    def __init__(self, dictionary: Dictionary) -> None:
        self._dictionary = dictionary
        self._places = dictionary.subindices(0x1003)
        self._present: set[int] = set()
        dictionary.checks[0x1003, 0] = only((0,))
        dictionary.reactions[0x1003, 0] = self._clear_history

    def reset(self) -> None:
        """Forget all errors."""
        self._present.clear()

    def raise_error(self, code: ErrorCode) -> bytes | None:
        """Note an error; return the message, or None where it is there already."""
        if code in self._present:
            return None
        self._present.add(code)
        self._keep(code)
        return _message(code, self._register())

    def tell(self, code: ErrorCode) -> bytes:
        """Return the message of an error that is over as it happens."""
        self._keep(code)
        return _message(code, self._register() | register_bits(code))

    def clear(self, *codes: int) -> bytes | None:
        """Take errors back, all where none is named; return the message where that changes something."""
        gone = self._present & set(codes) if codes else set(self._present)
        if not gone:
            return None
        self._present -= gone
        return _message(NO_ERROR, self._register())

    def _register(self) -> int:
        register = 0
        for present in self._present:
            register |= register_bits(present)
        self._dictionary.put(0x1001, 0, register)
        return register

    def _keep(self, code: int) -> None:
        book = self._dictionary
        count = min(book.number(0x1003, 0) + 1, len(self._places))
        for place in range(count, 1, -1):
            book.put(0x1003, place, book.number(0x1003, place - 1))
        book.put(0x1003, 1, code)
        book.put(0x1003, 0, count)

    def _clear_history(self) -> None:
        for place in self._places:
            self._dictionary.put(0x1003, place, 0)


def _message(code: int, register: int) -> bytes:
    return pack("<HB5x", code, register)
