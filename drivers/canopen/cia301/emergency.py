"""What a drive says when something is wrong: EMCY frames (CiA 301, 7.2.7). Pure."""

import struct
from dataclasses import dataclass
from typing import Final

_EMERGENCY: Final = struct.Struct("<HB5s")


@dataclass(frozen=True, slots=True)
class Emergency:
    """One EMCY frame.

    Attributes:
        code: error code; 0 says that an error is gone.
        register: error register, 0x1001.
        details: five bytes of the manufacturer.
    """

    code: int
    register: int
    details: bytes

    @classmethod
    def decode(cls, data: bytes) -> "Emergency":
        """From the 8 bytes of a frame.

        Raises:
            ValueError: there are not 8 bytes.
        """
        if len(data) != _EMERGENCY.size:
            raise ValueError(f"an EMCY has {_EMERGENCY.size} bytes, not {len(data)}")
        return cls(*_EMERGENCY.unpack(data))
