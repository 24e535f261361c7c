"""Objects of a CANopen dictionary: where they are, how they are coded, what one count means (CiA 301, 7.4)."""

import struct
from dataclasses import dataclass
from enum import Enum


class DataType(Enum):
    """Integer types of CiA 301, 7.1: the `struct` code of the little-endian value."""

    I8 = "b"
    U8 = "B"
    I16 = "h"
    U16 = "H"
    I32 = "i"
    U32 = "I"

    @property
    def size(self) -> int:
        """Length on the wire [bytes]."""
        return struct.calcsize("<" + self.value)


@dataclass(frozen=True, slots=True)
class DriveObject:
    """One entry of the object dictionary.

    Attributes:
        index, subindex: its place.
        type: how it is coded.
        name: in words, for messages.
        scale: what one count is worth, in `unit`.
        unit: SI; "rated current" for values that are relative to it.
        mappable: whether it can be put into a PDO.
    """

    index: int
    subindex: int
    type: DataType
    name: str
    scale: float = 1.0
    unit: str = ""
    mappable: bool = False

    def __hash__(self) -> int:
        return self.index << 8 | self.subindex  # looked up every cycle

    def pack(self, value: int) -> bytes:
        """The value as it is sent.

        Raises:
            struct.error: it does not fit the type.
        """
        return struct.pack("<" + self.type.value, value)

    def unpack(self, data: bytes) -> int:
        """The value as it was received; devices may send more bytes than the type has.

        Raises:
            struct.error: there are fewer bytes than the type has.
        """
        value: int = struct.unpack_from("<" + self.type.value, data)[0]
        return value

    @property
    def mapping(self) -> int:
        """The entry of a PDO mapping: index, subindex, length in bits."""
        return self.index << 16 | self.subindex << 8 | self.type.size * 8

    def __str__(self) -> str:
        return f"{self.name} (0x{self.index:04X}:{self.subindex:02X})"


_I8, _U8, _I16, _U16, _I32, _U32 = DataType.I8, DataType.U8, DataType.I16, DataType.U16, DataType.I32, DataType.U32

# communication (CiA 301)
DEVICE_TYPE = DriveObject(0x1000, 0, _U32, "device type")
SYNC_COB_ID = DriveObject(0x1005, 0, _U32, "COB-ID of SYNC")
CONSUMER_HEARTBEAT = DriveObject(0x1016, 1, _U32, "consumer heartbeat time")
PRODUCER_HEARTBEAT = DriveObject(0x1017, 0, _U16, "producer heartbeat time", 1e-3, "s")
VENDOR = DriveObject(0x1018, 1, _U32, "vendor ID")
PRODUCT = DriveObject(0x1018, 2, _U32, "product code")
REVISION = DriveObject(0x1018, 3, _U32, "revision number")
SERIAL = DriveObject(0x1018, 4, _U32, "serial number")
BEHAVIOUR_ON_COMMUNICATION_ERROR = DriveObject(0x1029, 1, _U8, "error behaviour, communication error")

# drive profile (CiA 402)
CONNECTION_LOSS_OPTION = DriveObject(0x6007, 0, _I16, "abort connection option code")
ERROR_CODE = DriveObject(0x603F, 0, _U16, "error code")
CONTROLWORD = DriveObject(0x6040, 0, _U16, "controlword", mappable=True)
STATUSWORD = DriveObject(0x6041, 0, _U16, "statusword", mappable=True)
QUICK_STOP_OPTION = DriveObject(0x605A, 0, _I16, "quick stop option code")
MODE = DriveObject(0x6060, 0, _I8, "modes of operation")
MODE_DISPLAY = DriveObject(0x6061, 0, _I8, "modes of operation display")
POSITION = DriveObject(0x6064, 0, _I32, "position actual value", mappable=True)
VELOCITY = DriveObject(0x606C, 0, _I32, "velocity actual value", mappable=True)
TARGET_TORQUE = DriveObject(0x6071, 0, _I16, "target torque", 1e-3, "rated current", mappable=True)
RATED_CURRENT = DriveObject(0x6075, 0, _U32, "motor rated current", 1e-3, "A")
TORQUE = DriveObject(0x6077, 0, _I16, "torque actual value", 1e-3, "rated current", mappable=True)
TARGET_POSITION = DriveObject(0x607A, 0, _I32, "target position", mappable=True)
ENCODER_INCREMENTS = DriveObject(0x608F, 1, _U32, "encoder increments")
ENCODER_REVOLUTIONS = DriveObject(0x608F, 2, _U32, "motor revolutions")
VELOCITY_UNIT = DriveObject(0x60A9, 0, _U32, "SI unit velocity")
TORQUE_OFFSET = DriveObject(0x60B2, 0, _I16, "torque offset", 1e-3, "rated current", mappable=True)
INTERPOLATION_PERIOD = DriveObject(0x60C2, 1, _U8, "interpolation period")
INTERPOLATION_EXPONENT = DriveObject(0x60C2, 2, _I8, "interpolation period exponent")
SUPPORTED_MODES = DriveObject(0x6502, 0, _U32, "supported drive modes")
