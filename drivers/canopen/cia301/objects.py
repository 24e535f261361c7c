"""Objects of a CANopen dictionary: where they are, how they are coded, what one count means (CiA 301, 7.4)."""

import struct
from dataclasses import dataclass
from enum import Enum

_DEVICE_PROFILES = 0x2000  # below this index stands what every CANopen device has


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

    @property
    def values(self) -> range:
        """What fits."""
        bits = 8 * self.size
        return range(-(1 << bits - 1), 1 << bits - 1) if self.value.islower() else range(1 << bits)


@dataclass(frozen=True, slots=True)
class DriveObject:
    """One entry of the object dictionary.

    Attributes:
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
        """The value in the first bytes of what was received.

        Raises:
            struct.error: there are fewer bytes than the type has.
        """
        value: int = struct.unpack_from("<" + self.type.value, data)[0]
        return value

    def read(self, data: bytes) -> int | None:
        """The value of an answer that tells its length; None of one that is not of this type.

        A mode or a code in more or fewer bytes means the same, as long as it fits the type. A quantity of another type
        is another one: drives have amperes, or floating point, where CiA 402 has permille.
        """
        value = int.from_bytes(data, "little", signed=self.type.value.islower())
        if len(data) == self.type.size:
            return value
        return value if data and not self.unit and value in self.type.values else None

    def words(self, value: int) -> str:
        """A value for a person: of CiA 301, whose words are made of parts, by its digits."""
        return f"0x{value:X}" if self.index < _DEVICE_PROFILES and self.type is DataType.U32 else f"{value}"

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
ERROR_FIELD = DriveObject(0x1003, 1, _U32, "newest entry of the error history")
GUARD_TIME = DriveObject(0x100C, 0, _U16, "guard time", 1e-3, "s")
LIFE_TIME_FACTOR = DriveObject(0x100D, 0, _U8, "life time factor")
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
FAULT_REACTION_OPTION = DriveObject(0x605E, 0, _I16, "fault reaction option code")
MODE = DriveObject(0x6060, 0, _I8, "modes of operation", mappable=True)
MODE_DISPLAY = DriveObject(0x6061, 0, _I8, "modes of operation display")
POSITION = DriveObject(0x6064, 0, _I32, "position actual value", mappable=True)
VELOCITY = DriveObject(0x606C, 0, _I32, "velocity actual value", mappable=True)
TARGET_TORQUE = DriveObject(0x6071, 0, _I16, "target torque", 1e-3, "rated current", mappable=True)
MAX_TORQUE = DriveObject(0x6072, 0, _U16, "max torque", 1e-3, "rated current")
RATED_CURRENT = DriveObject(0x6075, 0, _U32, "motor rated current", 1e-3, "A")
RATED_TORQUE = DriveObject(0x6076, 0, _U32, "motor rated torque", 1e-3, "N m")
TORQUE = DriveObject(0x6077, 0, _I16, "torque actual value", 1e-3, "rated current", mappable=True)
TARGET_POSITION = DriveObject(0x607A, 0, _I32, "target position", mappable=True)
HOME_OFFSET = DriveObject(0x607C, 0, _I32, "home offset")
LOWEST_POSITION = DriveObject(0x607D, 1, _I32, "software position limit, lowest")
HIGHEST_POSITION = DriveObject(0x607D, 2, _I32, "software position limit, highest")
PROFILE_VELOCITY = DriveObject(0x6081, 0, _U32, "profile velocity")
PROFILE_ACCELERATION = DriveObject(0x6083, 0, _U32, "profile acceleration")
PROFILE_DECELERATION = DriveObject(0x6084, 0, _U32, "profile deceleration")
QUICK_STOP_DECELERATION = DriveObject(0x6085, 0, _U32, "quick stop deceleration")
TORQUE_SLOPE = DriveObject(0x6087, 0, _U32, "torque slope")
ENCODER_INCREMENTS = DriveObject(0x608F, 1, _U32, "encoder increments")
ENCODER_REVOLUTIONS = DriveObject(0x608F, 2, _U32, "motor revolutions")
GEAR_MOTOR_TURNS = DriveObject(0x6091, 1, _U32, "gear ratio, motor revolutions")
GEAR_SHAFT_TURNS = DriveObject(0x6091, 2, _U32, "gear ratio, shaft revolutions")
FEED = DriveObject(0x6092, 1, _U32, "feed constant, feed")
FEED_TURNS = DriveObject(0x6092, 2, _U32, "feed constant, shaft revolutions")
VELOCITY_FACTOR = DriveObject(0x6096, 1, _U32, "velocity factor, numerator")
VELOCITY_DIVISOR = DriveObject(0x6096, 2, _U32, "velocity factor, divisor")
ACCELERATION_FACTOR = DriveObject(0x6097, 1, _U32, "acceleration factor, numerator")
ACCELERATION_DIVISOR = DriveObject(0x6097, 2, _U32, "acceleration factor, divisor")
HOMING_METHOD = DriveObject(0x6098, 0, _I8, "homing method")
HOMING_SPEED_SWITCH = DriveObject(0x6099, 1, _U32, "homing speed, search for switch")
HOMING_SPEED_ZERO = DriveObject(0x6099, 2, _U32, "homing speed, search for zero")
HOMING_ACCELERATION = DriveObject(0x609A, 0, _U32, "homing acceleration")
POSITION_UNIT = DriveObject(0x60A8, 0, _U32, "SI unit position")
VELOCITY_UNIT = DriveObject(0x60A9, 0, _U32, "SI unit velocity")
ACCELERATION_UNIT = DriveObject(0x60AA, 0, _U32, "SI unit acceleration")
VELOCITY_OFFSET = DriveObject(0x60B1, 0, _I32, "velocity offset", mappable=True)
TORQUE_OFFSET = DriveObject(0x60B2, 0, _I16, "torque offset", 1e-3, "rated current", mappable=True)
INTERPOLATION_PERIOD = DriveObject(0x60C2, 1, _U8, "interpolation period")
INTERPOLATION_EXPONENT = DriveObject(0x60C2, 2, _I8, "interpolation period exponent")
TARGET_VELOCITY = DriveObject(0x60FF, 0, _I32, "target velocity", mappable=True)
SUPPORTED_MODES = DriveObject(0x6502, 0, _U32, "supported drive modes")
