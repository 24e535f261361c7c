"""CANSimple: which message is which, and what is in it; low byte first, numbers of four bytes are floats.

The identifier is `node id << 5 | command`. A message that the ODrive sends is asked for by a remote frame. In its own
message file (DBC) a message has eight bytes, also where a value fills four: who reads by that file takes no shorter.

Source: ODrive, "CAN protocol" (firmware 0.6), and `odrive.enums` of its Python package 0.6.11 for states and errors.
"""

from enum import IntEnum
from struct import Struct


class Command(IntEnum):
    """Those that the driver uses."""

    GET_VERSION = 0x00
    HEARTBEAT = 0x01
    ESTOP = 0x02
    GET_ERROR = 0x03
    SET_AXIS_STATE = 0x07
    GET_ENCODER_ESTIMATES = 0x09
    SET_CONTROLLER_MODE = 0x0B
    SET_INPUT_TORQUE = 0x0E
    GET_IQ = 0x14
    GET_TEMPERATURE = 0x15
    GET_BUS = 0x17
    CLEAR_ERRORS = 0x18


VERSION = Struct("<BBBBBBBB")  # protocol, product line, version, variant, firmware major, minor, revision, unreleased
HEARTBEAT = Struct("<IBBB")  # active errors, state, procedure result, trajectory done
ERRORS = Struct("<II")  # active, what it was disarmed for
PAIR = Struct("<ff")  # position [turns], speed [turns/s]; Iq set and measured [A]; FET and motor [degC]; bus [V], [A]
TORQUE = Struct("<f4x")  # [N m]
WORD, MODES = Struct("<I4x"), Struct("<II")
IDLE, CLOSED_LOOP = 1, 8
TORQUE_CONTROL, PASSTHROUGH = 1, 1
WATCHDOG_TIMER_EXPIRED = 0x0100_0000

_ERRORS = {
    0x0000_0001: "initializing", 0x0000_0002: "system level", 0x0000_0004: "timing error",
    0x0000_0008: "missing estimate", 0x0000_0010: "bad config", 0x0000_0020: "driver fault",
    0x0000_0040: "missing input", 0x0000_0100: "DC bus over-voltage", 0x0000_0200: "DC bus under-voltage",
    0x0000_0400: "DC bus over-current", 0x0000_0800: "DC bus over-regeneration",
    0x0000_1000: "current limit violation", 0x0000_2000: "motor over-temperature",
    0x0000_4000: "inverter over-temperature", 0x0000_8000: "velocity limit violation",
    0x0001_0000: "position limit violation", 0x0002_0000: "requested current too high",
    WATCHDOG_TIMER_EXPIRED: "watchdog timer expired", 0x0200_0000: "e-stop requested",
    0x0400_0000: "spin-out detected", 0x0800_0000: "brake resistor disarmed",
    0x1000_0000: "thermistor disconnected", 0x4000_0000: "calibration error",
}  # fmt: skip


def can_id(node_id: int, command: Command) -> int:
    """The identifier of a message."""
    return node_id << 5 | command


def error_names(word: int) -> str:
    """The errors by name; "" for none."""
    if not word:  # as in nearly every cycle
        return ""
    names = [name for bit, name in _ERRORS.items() if word & bit]
    unknown = word & ~sum(_ERRORS)
    return ", ".join([*names, *([f"{unknown:#x}"] if unknown else [])])
