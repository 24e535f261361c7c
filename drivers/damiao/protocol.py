"""Frames of the MIT protocol as Damiao has it, and its registers: pure functions.

A command has five numbers in eight bytes, high bits first: position (16 bits), speed, stiffness, damping, torque (12
each). Each is a whole number over a range, of which the actuator has its own: what a torque means depends on it. The
answer has state and id, position (16), speed and torque (12 each), and two temperatures. Registers are read and written
at identifier 0x7FF.

Source: Damiao, "DM-J series" manuals; codes and register numbers compared with `damiao-motor` 1.0.
"""

from enum import IntEnum
from struct import Struct
from typing import NamedTuple

ENABLE, DISABLE, CLEAR_ERRORS = (b"\xff" * 7 + bytes((last,)) for last in (0xFC, 0xFD, 0xFB))
REGISTERS_ID = 0x7FF
READ, WRITE, ASK = 0x33, 0x55, 0xCC
DAMPING_FULL = 5.0  # [N m s/rad]; stiffness and damping have the same range in every model
ENABLED = 1
TIMEOUT_STEP_S = 50e-6
MIT_MODE = 1
FLOAT, WORD = Struct("<f"), Struct("<I")

_ERRORS = {
    0x8: "over-voltage", 0x9: "under-voltage", 0xA: "over-current", 0xB: "driver over-temperature",
    0xC: "motor over-temperature", 0xD: "communication lost: its watchdog has stopped it", 0xE: "overload",
}  # fmt: skip


class Register(IntEnum):
    """Those that the driver uses."""

    TIMEOUT = 9  # [50 us]
    CONTROL_MODE = 10
    SOFTWARE = 14
    POSITION_RANGE = 21  # [rad], float
    SPEED_RANGE = 22  # [rad/s], float
    TORQUE_RANGE = 23  # [N m], float


class Ranges(NamedTuple):
    """What the largest number of a frame means, either way."""

    position_rad: float
    speed_rad_s: float
    torque_n_m: float


MODELS: dict[str, Ranges] = {
    "DM3507": Ranges(12.566, 50, 5), "DM4310": Ranges(12.5, 30, 10), "DM4310P": Ranges(12.5, 50, 10),
    "DM4340": Ranges(12.5, 10, 28), "DM4340P": Ranges(12.5, 10, 28), "DM6006": Ranges(12.5, 45, 20),
    "DM8006": Ranges(12.5, 45, 40), "DM8009": Ranges(12.5, 45, 54), "DM10010L": Ranges(12.5, 25, 200),
    "DM10010": Ranges(12.5, 20, 200), "DMH3510": Ranges(12.5, 280, 1), "DMG6215": Ranges(12.5, 45, 10),
    "DMH6220": Ranges(12.5, 45, 10),
}  # fmt: skip
"""Ranges of the models as they are delivered."""


class Feedback(NamedTuple):
    """What an actuator answers."""

    state: int
    position_rad: float
    speed_rad_s: float
    torque_n_m: float
    temperature_c: float


def command(ranges: Ranges, torque_n_m: float, damping: float = 0.0) -> bytes:
    """The frame of a torque, with both gains zero unless it shall damp [N m s/rad]."""
    damping_word = round(damping / DAMPING_FULL * 0xFFF)
    word = _STAND | damping_word << 12 | _word(torque_n_m, ranges.torque_n_m, 12)
    return word.to_bytes(8, "big")


def feedback(data: bytes, ranges: Ranges) -> Feedback:
    """Take an answer of eight bytes apart."""
    word = int.from_bytes(data, "big")
    return Feedback(
        data[0] >> 4,
        _value(word >> 40 & 0xFFFF, ranges.position_rad, 16),
        _value(word >> 28 & 0xFFF, ranges.speed_rad_s, 12),
        _value(word >> 16 & 0xFFF, ranges.torque_n_m, 12),
        max(data[6], data[7]),
    )


def register_frame(motor_id: int, what: int, register: int = 0, data: bytes = bytes(4)) -> bytes:
    """The frame that reads or writes a register, or asks for an answer without moving anything."""
    return bytes((motor_id & 0xFF, motor_id >> 8, what, register)) + data


def is_register(data: bytes, motor_id: int, register: int) -> bool:
    """Whether a frame is the answer to the reading or writing of a register."""
    known = data[2:3] in (bytes((READ,)), bytes((WRITE,)))
    return len(data) == 8 and known and data[0] == motor_id & 0xFF and data[1] == motor_id >> 8 and data[3] == register


def error_name(state: int) -> str:
    """The error by name; "" where the state is none."""
    return _ERRORS.get(state, "" if state in (0, ENABLED) else f"state {state:#x}")


def _word(value: float, full: float, bits: int) -> int:
    top = (1 << bits) - 1
    return round((min(max(value, -full), full) + full) / (2.0 * full) * top)


_STAND = _word(0.0, 1.0, 16) << 48 | _word(0.0, 1.0, 12) << 36
"""Position and speed of 0 in their places; with gains of 0 they mean nothing."""


def _value(word: int, full: float, bits: int) -> float:
    return word * 2.0 * full / ((1 << bits) - 1) - full
