"""SDO abort codes (CiA 301)."""

from collections.abc import Callable, Container
from enum import IntEnum


class AbortCode(IntEnum):
    """Why a transfer was ended."""

    TOGGLE_BIT = 0x05030000
    UNKNOWN_COMMAND = 0x05040001
    UNSUPPORTED_ACCESS = 0x06010000
    WRITE_ONLY = 0x06010001
    READ_ONLY = 0x06010002
    NO_OBJECT = 0x06020000
    NOT_MAPPABLE = 0x06040041
    MAPPING_TOO_LONG = 0x06040042
    PARAMETER_INCOMPATIBLE = 0x06040043
    LENGTH_TOO_HIGH = 0x06070012
    LENGTH_TOO_LOW = 0x06070013
    NO_SUBINDEX = 0x06090011
    INVALID_VALUE = 0x06090030
    VALUE_TOO_HIGH = 0x06090031
    VALUE_TOO_LOW = 0x06090032
    DEVICE_STATE = 0x08000022


class Abort(Exception):
    """Raised where an access to the dictionary is refused. The SDO server turns it into an abort transfer."""

    def __init__(self, code: int) -> None:
        super().__init__(f"SDO abort 0x{code:08X}")
        self.code = code


def only(allowed: Container[int]) -> Callable[[int], None]:
    """Return the check of an object that takes these values alone."""

    def check(value: int) -> None:
        if value not in allowed:
            raise Abort(AbortCode.INVALID_VALUE)

    return check
