"""The commands that the driver uses, as the manual numbers them; everything on the wire is big-endian.

Source: Basicmicro, RoboClaw Series User Manual, "Packet Serial" and "Advance Packet Serial".
"""

from dataclasses import dataclass, field
from struct import Struct

ACKNOWLEDGED = b"\xff"
DUTY_FULL = 32767  # of commands 32, 33 and 48: +-100 %
CURRENT_A = 0.01  # one step of commands 49 and 133 .. 136
BACKWARD = 1  # in the direction byte of commands 18 and 19
CRC_BYTES = 2


@dataclass(frozen=True, slots=True)
class Read:
    """A command that is answered with data."""

    number: int
    layout: Struct
    meaning: str
    reply_bytes: int = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "reply_bytes", self.layout.size + CRC_BYTES)


@dataclass(frozen=True, slots=True)
class Write:
    """A command that is acknowledged with 0xFF."""

    number: int
    layout: Struct
    meaning: str


SET_TIMEOUT = Write(14, Struct(">B"), "serial timeout")  # [100 ms]; 0 is never
READ_TIMEOUT = Read(15, Struct(">B"), "serial timeout")
READ_VERSION = 21  # text, "\n\0", CRC
LONGEST_VERSION_BYTES = 48
SUPPLY = Read(24, Struct(">H"), "main battery voltage")  # [0.1 V]
APPLIED_DUTY = Read(48, Struct(">hh"), "applied PWM")  # M1, M2; +-32767
CURRENTS = Read(49, Struct(">hh"), "motor currents")  # M1, M2 [10 mA]
TEMPERATURE = Read(82, Struct(">H"), "temperature")  # [0.1 degC]
STATUS_32_BIT = Read(90, Struct(">I"), "status")
STATUS_16_BIT = Read(90, Struct(">H"), "status")  # older firmware


@dataclass(frozen=True, slots=True)
class Channel:
    """The commands of one of the two motors.

    Attributes:
        index: of its value where both motors are answered at once.
        set_duty: i16, +-32767.
        encoder: u32 count, u8 status (bit 0 underflow, bit 1 backward, bit 2 overflow).
        speed: i32 counts/s over the last second's pulses, u8 direction: 0 forward, 1 backward.
        set_current_limit: u32 highest [10 mA], u32 0.
        current_limit: the same, read.
    """

    index: int
    set_duty: Write
    encoder: Read
    speed: Read
    set_current_limit: Write
    current_limit: Read


CHANNELS = {
    1: Channel(
        0,
        Write(32, Struct(">h"), "duty of M1"),
        Read(16, Struct(">IB"), "encoder of M1"),
        Read(18, Struct(">iB"), "speed of M1"),
        Write(133, Struct(">II"), "current limit of M1"),
        Read(135, Struct(">II"), "current limit of M1"),
    ),
    2: Channel(
        1,
        Write(33, Struct(">h"), "duty of M2"),
        Read(17, Struct(">IB"), "encoder of M2"),
        Read(19, Struct(">iB"), "speed of M2"),
        Write(134, Struct(">II"), "current limit of M2"),
        Read(136, Struct(">II"), "current limit of M2"),
    ),
}
