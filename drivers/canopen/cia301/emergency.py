"""What a drive says when something is wrong: EMCY frames (CiA 301, 7.2.7) and error codes by name. Pure."""

import struct
from dataclasses import dataclass
from typing import Final

HEARTBEAT_LOST: Final = 0x8130

_NAMES: Final = {
    0x0000: "no error",
    0x1000: "generic error",
    0x2220: "continuous over-current inside the device",
    0x2310: "continuous over-current",
    0x2320: "short circuit or earth leakage",
    0x2330: "earth leakage",
    0x2340: "short circuit",
    0x3110: "mains over-voltage",
    0x3120: "mains under-voltage",
    0x3210: "over-voltage of the DC link",
    0x3220: "under-voltage of the DC link",
    0x3310: "output over-voltage",
    0x4110: "ambient temperature too high",
    0x4210: "device temperature too high",
    0x4310: "drive temperature too high",
    0x5113: "5 V supply low",
    0x5114: "supply of the controller low",
    0x5441: "enable input (safe torque off)",
    0x5530: "non-volatile memory",
    0x6100: "internal software error",
    0x6320: "parameter error",
    0x7121: "motor blocked",
    0x7305: "incremental encoder 1",
    0x7306: "incremental encoder 2",
    0x7320: "position sensor",
    0x7510: "serial interface",
    0x8110: "CAN overrun, frames lost",
    0x8120: "CAN error passive",
    HEARTBEAT_LOST: "no heartbeat from the host in time",
    0x8140: "recovered from CAN bus-off",
    0x8150: "two senders of one COB-ID",
    0x8210: "PDO too short, not processed",
    0x8220: "PDO longer than mapped",
    0x8250: "RPDO timeout",
    0x8311: "excess torque",
    0x8400: "velocity control",
    0x8500: "position control",
    0x8611: "following error",
    0x8612: "position limit",
    0x8613: "homing",
}
_CLASSES: Final = {
    0x1: "generic error",
    0x2: "current",
    0x3: "voltage",
    0x4: "temperature",
    0x5: "device hardware",
    0x6: "device software",
    0x7: "additional modules",
    0x8: "monitoring",
    0x9: "external error",
    0xF: "manufacturer specific: see the manual of the drive",
}
_EMERGENCY: Final = struct.Struct("<HB5s")


def error_name(code: int) -> str:
    """An error code of EMCY or 0x603F, in words; by its class where it has no name of its own."""
    return f"0x{code:04X}, {_NAMES.get(code) or _CLASSES.get(code >> 12, 'not in CiA 301 or 402')}"


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

    def __str__(self) -> str:
        return error_name(self.code)
