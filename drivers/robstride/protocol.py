"""RobStride's own protocol: frames with identifiers of 29 bits. Pure functions.

An identifier has a type (5 bits), 16 bits of data, and the id of whom it is for. A command has the torque in these 16
bits, and position, speed, stiffness and damping as words of 16 bits, high byte first. An answer has faults and the mode
in its identifier, and position, speed, torque and temperature as such words. Parameters are read and written by index,
low byte first.

Source: RobStride, "RS00" to "RS06" and "EL05" user manuals of 2026-04, chapters 3.3 and 4.1; parameters compared with
`robstride-dynamics` 0.0.1.
"""

from enum import IntEnum
from struct import Struct
from typing import NamedTuple

from drivers.can_bus.port import EXTENDED
from drivers.mit.frames import Frame, Motion, Ranges, from_word, to_word

STATE_BITS = 0x00FF_0000  # of an answer's identifier: faults and mode
HOST = 0xFD
RUNS = 2
TIMEOUT_STEP_S = 50e-6
OPERATION_MODE = 0
FLOAT, WORD = Struct("<f"), Struct("<I")
VERSION = bytes((0x00, 0xC4))
_WORDS = Struct(">HHHH")
_CENTRE = to_word(0.0, 1.0, 16)

_FAULTS = {
    0x01: "under-voltage", 0x02: "over-current", 0x04: "over-temperature", 0x08: "encoder fault",
    0x10: "overload: motor locked", 0x20: "encoder not calibrated",
}  # fmt: skip


class Kind(IntEnum):
    """Types of frames that the driver uses."""

    IDENTIFY = 0
    COMMAND = 1
    FEEDBACK = 2
    ENABLE = 3
    STOP = 4
    READ = 17
    WRITE = 18


class Parameter(IntEnum):
    """Those that the driver uses."""

    RUN_MODE = 0x7005
    TORQUE_LIMIT = 0x700B  # [N m], float
    POSITION = 0x7019  # [rad], float
    SUPPLY = 0x701C  # [V], float
    TIMEOUT = 0x7028  # [50 us]


MODELS: dict[str, Ranges] = {
    "RS00": Ranges(12.57, 33.0, 14.0), "RS01": Ranges(12.57, 44.0, 17.0), "RS02": Ranges(12.57, 44.0, 17.0),
    "RS03": Ranges(12.57, 20.0, 60.0, 100.0), "RS04": Ranges(12.57, 15.0, 120.0, 100.0),
    "RS05": Ranges(12.57, 50.0, 5.5), "RS06": Ranges(12.57, 50.0, 36.0, 100.0), "EL05": Ranges(12.57, 50.0, 5.5),
}  # fmt: skip
"""Ranges of the models."""


class Feedback(NamedTuple):
    """What an actuator answers."""

    motion: Motion
    temperature_c: float
    mode: int
    fault: str


def frame(kind: Kind, motor_id: int, data: bytes = bytes(8), extra: int = HOST) -> Frame:
    """A frame to an actuator; `extra` are the 16 bits in its identifier."""
    return EXTENDED | kind << 24 | extra << 8 | motor_id, data


def answer_id(kind: Kind, motor_id: int) -> int:
    """Identifier of answers of a type, without the bits of a state."""
    return EXTENDED | kind << 24 | motor_id << 8 | HOST


def identity_id(motor_id: int) -> int:
    """Identifier of the answer to `IDENTIFY`."""
    return EXTENDED | motor_id << 8 | 0xFE


def command(motor_id: int, ranges: Ranges, torque_n_m: float, damping: float = 0.0) -> Frame:
    """The frame of a torque, with both gains zero unless it shall damp [N m s/rad]."""
    data = _WORDS.pack(_CENTRE, _CENTRE, 0, round(damping / ranges.damping * 0xFFFF))
    return frame(Kind.COMMAND, motor_id, data, to_word(torque_n_m, ranges.torque_n_m, 16))


def parameter_frame(kind: Kind, motor_id: int, parameter: int, data: bytes = bytes(4)) -> Frame:
    """The frame that reads or writes a parameter."""
    return frame(kind, motor_id, parameter.to_bytes(2, "little") + bytes(2) + data)


def feedback(can_id: int, data: bytes, ranges: Ranges) -> Feedback:
    """Take an answer of eight bytes apart."""
    position, speed, torque, temperature = _WORDS.unpack(data)
    moves = Motion(
        from_word(position, ranges.position_rad, 16),
        from_word(speed, ranges.speed_rad_s, 16),
        from_word(torque, ranges.torque_n_m, 16),
    )
    return Feedback(moves, 0.1 * temperature, can_id >> 22 & 3, fault_names(can_id >> 16 & 0x3F))


def fault_names(bits: int) -> str:
    """The faults by name; "" for none."""
    return ", ".join(name for bit, name in _FAULTS.items() if bits & bit) if bits else ""
