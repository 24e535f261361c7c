"""Damiao's part of the MIT protocol: answers with a state, and registers. Pure functions.

The answer has state and id, position, speed and torque, and two temperatures. Registers are read and written at
identifier 0x7FF.

Source: Damiao, "DM-J series" manuals; codes and register numbers compared with `damiao-motor` 1.0.
"""

from enum import IntEnum
from struct import Struct
from typing import NamedTuple

from drivers.mit.frames import Motion, Ranges, motion

REGISTERS_ID = 0x7FF
READ, WRITE, ASK = 0x33, 0x55, 0xCC
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
    motion: Motion
    temperature_c: float


def feedback(data: bytes, ranges: Ranges) -> Feedback:
    """Take an answer of eight bytes apart."""
    return Feedback(data[0] >> 4, motion(int.from_bytes(data[1:6], "big"), ranges), max(data[6], data[7]))


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
