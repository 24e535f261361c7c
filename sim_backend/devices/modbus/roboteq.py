"""A drive that answers like a Roboteq controller on Modbus; what is known of it is in docs/modbus-map.md."""

from collections.abc import Callable
from threading import RLock

from drivers.contract import Sample
from sim_backend.devices.axis import OFF, VOLTAGE, Axis, Demand, Device
from sim_backend.devices.modbus.register_file import (
    ILLEGAL_ADDRESS,
    ILLEGAL_FUNCTION,
    ILLEGAL_VALUE,
    Kind,
    Refused,
    Unanswered,
    from_words,
    to_words,
)
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

WATCHDOG_S = 1.0  # silence after which the command becomes 0: RWD of the controller's configuration, as delivered
_READ, _WRITE = 4, 16
_WORDS = 2
_MOTOR_COMMAND = 0x0001
_FULL = 1000
_VARIABLES = range(1, 5)
_SET_VARIABLE, _VARIABLE = 0x00A0, 0x20C0
_OVERHEAT, _UNDER_VOLTAGE, _SHORT, _EMERGENCY = 1, 4, 8, 16


class Roboteq(Device):
    """Channel 1 of a controller, in open loop.

    Args:
        parameters: the joint on it.
        seed: of the plant.
    """

    def __init__(self, parameters: PlantParameters, seed: int = 0) -> None:
        self.lock = RLock()
        self.axis = Axis(parameters, self, seed)
        self._command = 0
        self._told_s = 0.0
        self._timeouts = 0
        self._variables = dict.fromkeys(_VARIABLES, 0)
        self._turn_counts = parameters.encoder.counts_per_turn
        self._queries = self._make_queries()

    def report(self) -> dict[str, object]:
        """Say what the drive is about."""
        return {
            "kind": "modbus, as a Roboteq",
            "command": self._command,
            "watchdog_s": WATCHDOG_S,
            "watchdog_trips": self._timeouts,
        }

    def demand(self, seen: Sample) -> Demand:  # noqa: ARG002
        """Return what the stage does for the coming tick."""
        if self._command and self.axis.time_s - self._told_s > WATCHDOG_S:
            self._timeouts += 1
            self._command = 0
        if self.axis.trip() is not None or self.axis.torque_is_disabled():
            self._command = 0
            return OFF
        return Demand(VOLTAGE, self._command / _FULL)

    def read(self, function: int, address: int, count: int) -> list[int]:
        """Return one value."""
        if function != _READ:
            raise Refused(ILLEGAL_FUNCTION)
        if count != _WORDS:
            raise Unanswered
        if address not in self._queries:
            raise Refused(ILLEGAL_ADDRESS)
        return to_words(self._queries[address](), Kind.I32, low_word_first=False)

    def write(self, function: int, address: int, words: list[int]) -> None:
        """Write one value."""
        if function != _WRITE:
            raise Refused(ILLEGAL_FUNCTION)
        if len(words) != _WORDS:
            raise Unanswered
        value = from_words(words, Kind.I32, low_word_first=False)
        if address == _MOTOR_COMMAND:
            if abs(value) > _FULL:
                raise Refused(ILLEGAL_VALUE)
            self._command = value
        elif address - _SET_VARIABLE in self._variables:
            self._variables[address - _SET_VARIABLE] = value
        else:
            raise Refused(ILLEGAL_ADDRESS)
        self._told_s = self.axis.time_s

    def _make_queries(self) -> dict[int, Callable[[], int]]:
        axis = self.axis
        variables = {_VARIABLE + place: self._variable(place) for place in _VARIABLES}
        return variables | {
            0x2001: lambda: round(axis.current_a * 10.0),
            0x2021: lambda: self._command,
            0x2041: lambda: round(axis.seen.duty * _FULL),
            0x2061: lambda: round(axis.counts_per_s() * 60.0 / self._turn_counts),
            0x2081: lambda: (axis.counts() + 2**31) % 2**32 - 2**31,
            0x21A1: lambda: 120,
            0x21A2: lambda: round(axis.seen.supply_v * 10.0),
            0x21A3: lambda: 4730,
            0x21E1: lambda: round(axis.temperature_c),
            0x21E2: lambda: round(axis.temperature_c),
            0x2240: self._faults,
        }

    def _variable(self, place: int) -> Callable[[], int]:
        return lambda: self._variables[place]

    def _faults(self) -> int:
        trip = self.axis.trip()
        flags = _EMERGENCY if self.axis.torque_is_disabled() else 0
        return flags if trip is None else flags | tripped(trip, _OVERHEAT, _SHORT, _UNDER_VOLTAGE, _SHORT)
