"""Frames of the register protocol, made and taken apart by mjbots' library `moteus`; faults by name.

Source: mjbots, "Register reference" of the moteus documentation.
"""

from math import copysign, nan
from struct import error
from typing import Any, NamedTuple

import moteus
from moteus.moteus import parse_diagnostic_message
from moteus.protocol import parse_reply

from drivers.actuator.reading import Reading

STOPPED, FAULT, POSITION, TIMEOUT, BRAKE = 0, 1, 10, 11, 15
POWERED = frozenset({2, 3, 4, POSITION, BRAKE})  # 2 .. 4: about to begin
LONGEST_TEXT = 48
_REGISTERS = (0x000, 0x001, 0x002, 0x003, 0x004, 0x00D, 0x00E, 0x00F)  # of `State`, in its order

_FAULTS = {
    32: "calibration fault", 33: "motor driver fault", 34: "over-voltage", 35: "encoder fault",
    36: "motor not configured", 37: "PWM cycle overrun", 38: "over-temperature", 39: "outside its position limits",
    40: "under-voltage", 41: "configuration changed", 42: "no valid commutation encoder",
    43: "no valid output encoder", 44: "driver enable fault", 46: "timing violation", 48: "invalid position limits",
    49: "position control error", 50: "velocity control error",
}  # fmt: skip


class State(NamedTuple):
    """What each exchange reads. Absent: NaN."""

    mode: int
    turns: float
    turns_s: float
    torque_n_m: float
    current_a: float
    supply_v: float
    temperature_c: float
    fault: int


def _resolution() -> Any:
    wide = moteus.QueryResolution()
    wide.mode = wide.fault = moteus.INT8
    for name in ("position", "velocity", "torque", "q_current", "voltage", "temperature"):
        setattr(wide, name, moteus.F32)
    return wide


class Frames:
    """The data of the frames to one controller; nothing is sent here.

    Args:
        servo_id: of the controller.
        watchdog_s: silence after which it stops [s], with every torque.
    """

    def __init__(self, servo_id: int, watchdog_s: float) -> None:
        self._maker = moteus.Controller(id=servo_id, query_resolution=_resolution(), transport=object())
        self._watchdog_s = watchdog_s
        self.question = bytes(self._maker.make_query().data)
        self.stop = bytes(self._maker.make_stop(query=True).data)
        self.brake = bytes(self._maker.make_brake(query=True).data)
        self.text_question = bytes(self._maker.make_diagnostic_read(max_length=LONGEST_TEXT).data)
        numbers = dict.fromkeys((257, 288, 289, 290), moteus.INT32)
        self.identity = bytes(self._maker.make_custom_query(numbers).data)

    def torque(self, torque_n_m: float) -> bytes:
        """A torque alone: its position mode with both gains at zero, the place where it is, and a time limit."""
        command = self._maker.make_position(
            position=nan, velocity=0.0, feedforward_torque=torque_n_m, kp_scale=0.0, kd_scale=0.0, ilimit_scale=0.0,
            watchdog_timeout=self._watchdog_s, query=True,
        )  # fmt: skip
        return bytes(command.data)

    def text(self, line: str) -> bytes:
        """A line to its console; a long one is more than a frame."""
        return bytes(self._maker.make_diagnostic_write(line.encode("ascii")).data)


def registers(data: bytes) -> dict[int, Any]:
    """Values by register of an answer; those that cannot be read are left out."""
    try:
        return dict(parse_reply(data))
    except (ValueError, LookupError, RuntimeError, error):  # garbled, on a line without checksums
        return {}


def state(data: bytes) -> State | None:
    """What an answer says; None where it is none to the question of a cycle."""
    found = registers(data)
    return _state(found) if set(_REGISTERS) <= found.keys() else None


def part_of_state(data: bytes) -> State | None:
    """What an answer to another host says, who may have asked for less; None where it tells no position or mode."""
    found = registers(data)
    return _state(found) if {0x000, 0x001} <= found.keys() else None


def _state(found: dict[int, Any]) -> State:
    mode, *values, fault = (found.get(register, nan) for register in _REGISTERS)
    return State._make((int(mode), *values, 0 if fault != fault else int(fault)))


def text_of(data: bytes) -> bytes:
    """What an answer has of its console."""

    class Message:
        """As the library takes it."""

    message: Any = Message()
    message.data = data
    return bytes(parse_diagnostic_message(message, 1) or b"")


def reading_of(found: State, counts_per_turn: float, asked_s: float) -> Reading:
    """An answer in SI."""
    # the sign of its phase current depends on how its output is set up, that of its torque does not
    current_a = copysign(found.current_a, found.torque_n_m)
    return Reading(
        asked_s, found.turns * counts_per_turn, found.turns_s * counts_per_turn, nan, current_a, found.torque_n_m,
        found.supply_v, found.temperature_c, found.mode in POWERED, fault_name(found),
    )  # fmt: skip


def fault_name(found: State) -> str:
    """What has stopped it, by name; "" for nothing."""
    if found.mode == TIMEOUT:
        return "its watchdog has stopped it: no command came in time"
    if found.mode != FAULT:
        return ""
    return _FAULTS.get(found.fault, f"fault {found.fault}")
