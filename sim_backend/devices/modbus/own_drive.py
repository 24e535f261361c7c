"""Our own drive on Modbus: docs/modbus-map.md."""

from collections.abc import Callable
from enum import IntEnum
from threading import RLock

from drivers.contract import Sample
from sim_backend.devices.axis import BRAKE, CURRENT, OFF, VOLTAGE, Axis, Demand, Device
from sim_backend.devices.modbus.register_file import (
    ILLEGAL_FUNCTION,
    ILLEGAL_VALUE,
    Kind,
    Refused,
    Register,
    RegisterFile,
)
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

U16, I16, U32, I32 = Kind.U16, Kind.I16, Kind.U32, Kind.I32
COMMAND_BLOCK = range(5)
DEVICE, FIRMWARE, SERIAL = 0xFB01, 0x0100, 1
PRODUCT = "simulated drive"
_PRODUCT_AT, _PRODUCT_WORDS = 210, 10

REGISTERS = (
    Register(0, "control", U16, 0, 3),
    Register(1, "mode", U16, 0, 1),
    Register(2, "duty_demand", I16, -10000, 10000),
    Register(3, "current_demand", I32, -100_000, 100_000),
    Register(16, "watchdog", U16, 0, 60_000),
    Register(17, "current_limit", U16, 1, 65_535),
    Register(18, "word_order", U16, 0, 1),
    Register(100, "status", U16),
    Register(101, "fault", U16),
    Register(102, "position", I32),
    Register(104, "velocity", I32),
    Register(106, "duty", I16),
    Register(107, "current", I16),
    Register(108, "supply", U16),
    Register(109, "temperature", I16),
    Register(110, "time", U32),
    Register(200, "device", U16),
    Register(201, "firmware", U16),
    Register(202, "serial_number", U32),
    *(Register(_PRODUCT_AT + place, f"product_{place}", U16) for place in range(_PRODUCT_WORDS)),
)

DEFAULTS = {
    "control": 0,
    "mode": 0,
    "duty_demand": 0,
    "current_demand": 0,
    "watchdog": 0,
    "current_limit": 3000,
    "word_order": 0,
}
READS, WRITES = frozenset({3, 4, 23}), frozenset({6, 16, 23})
_WARM_C = 85.0


def identity() -> dict[str, int]:
    """Return the values that never change."""
    text = PRODUCT.encode("ascii").ljust(2 * _PRODUCT_WORDS, b"\0")
    words = {f"product_{place}": text[2 * place] << 8 | text[2 * place + 1] for place in range(_PRODUCT_WORDS)}
    return {"device": DEVICE, "firmware": FIRMWARE, "serial_number": SERIAL, **words}


class Control(IntEnum):
    """Register 0."""

    OFF = 0
    ON = 1
    QUICK_STOP = 2
    CLEAR = 3


class State(IntEnum):
    """Bits of register 100; of these one at most."""

    OFF = 0
    ON = 1
    STOPPING = 2
    FAULT = 4


class Fault(IntEnum):
    """Register 101."""

    NONE = 0
    WATCHDOG = 1
    OVER_CURRENT = 2
    UNDER_VOLTAGE = 3
    OVER_TEMPERATURE = 4
    INTERNAL = 5


_LIMITED, _DISABLED, _WARM = 1 << 3, 1 << 4, 1 << 5


class OwnDrive(Device):
    """One drive.

    Args:
        parameters: the joint on it.
        low_word_first: word order at the start.
        seed: of the plant.
    """

    def __init__(self, parameters: PlantParameters, low_word_first: bool = False, seed: int = 0) -> None:
        self.lock = RLock()
        self._kept = identity() | DEFAULTS | {"word_order": int(low_word_first)}
        self._state = State.OFF
        self._fault = Fault.NONE
        self._limited = False
        self._told_s = 0.0  # last write into the command block
        self._timeouts = 0
        self._file = RegisterFile(REGISTERS, self._value, lambda: self._kept["word_order"] == 1)
        self.axis = Axis(parameters, self, seed)
        self._live = self._make_live()

    def report(self) -> dict[str, object]:
        """Say what the drive is about."""
        return {
            "kind": "modbus",
            "state": self._state.name,
            "fault": self._fault.name,
            "watchdog_s": self._kept["watchdog"] * 1e-3,
            "watchdog_trips": self._timeouts,
        }

    # the registers --------------------------------------------------------------------------------------

    def read(self, function: int, address: int, count: int) -> list[int]:
        """Return registers."""
        if function not in READS:
            raise Refused(ILLEGAL_FUNCTION)
        return self._file.read(address, count)

    def write(self, function: int, address: int, words: list[int]) -> None:
        """Write registers, all or none."""
        if function not in WRITES:
            raise Refused(ILLEGAL_FUNCTION)
        wanted = self._file.parse(address, words)
        if wanted.get("mode", self._kept["mode"]) != self._kept["mode"] and self.axis.mode_is_refused():
            raise Refused(ILLEGAL_VALUE)
        self._kept |= wanted
        if address in COMMAND_BLOCK:
            self._told_s = self.axis.time_s
            self._obey(Control(self._kept["control"]))

    def _obey(self, control: Control) -> None:
        match control:
            case Control.OFF if self._state is not State.FAULT:
                self._state = State.OFF
            case Control.ON if self._state is State.OFF and not self.axis.torque_is_disabled():
                self._state = State.ON
            case Control.QUICK_STOP if self._state is State.ON:
                self._state = State.STOPPING
            case Control.CLEAR:
                self._clear()

    def _clear(self) -> None:
        self._kept["control"] = Control.OFF
        if self.axis.trip() is None:
            self._state, self._fault = State.OFF, Fault.NONE

    def _value(self, name: str) -> int:
        return self._live[name]() if name in self._live else self._kept[name]

    def _make_live(self) -> dict[str, Callable[[], int]]:
        axis = self.axis
        return {
            "status": self._status,
            "fault": lambda: self._fault,
            "position": lambda: (axis.counts() + 2**31) % 2**32 - 2**31,
            "velocity": lambda: round(axis.counts_per_s()),
            "duty": lambda: round(axis.seen.duty * 1e4),
            "current": lambda: round(axis.current_a * 1e3),
            "supply": lambda: round(axis.seen.supply_v * 1e2),
            "temperature": lambda: round(axis.temperature_c * 10.0),
            "time": lambda: round(axis.seen.time_s * 1e3) % 2**32,
        }

    def _status(self) -> int:
        status = int(self._state)
        status |= _LIMITED if self._limited else 0
        status |= _DISABLED if self.axis.torque_is_disabled() else 0
        return status | (_WARM if self.axis.temperature_c >= _WARM_C else 0)

    # the real-time half ---------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:
        """Return what the stage does for the coming tick."""
        self._watch()
        self._limited = False
        if self._state is State.STOPPING:
            return self._stop(seen)
        if self._state is not State.ON:
            return OFF
        limit_a = self._kept["current_limit"] * 1e-3
        if self._kept["mode"] == 1:
            wanted_a = self._kept["current_demand"] * 1e-3
            self._limited = abs(wanted_a) > limit_a
            return Demand(CURRENT, max(-limit_a, min(limit_a, wanted_a)))
        return self._chopped(Demand(VOLTAGE, self._kept["duty_demand"] * 1e-4), seen, limit_a)

    def _watch(self) -> None:
        trip = self.axis.trip()
        if trip is not None:
            found = tripped(trip, Fault.OVER_TEMPERATURE, Fault.OVER_CURRENT, Fault.UNDER_VOLTAGE, Fault.INTERNAL)
            self._fail(Fault(found))
        elif self.axis.torque_is_disabled() and self._state is not State.FAULT:
            self._state = State.OFF
            self._kept["control"] = Control.OFF
        watchdog_s = self._kept["watchdog"] * 1e-3
        powered = self._state in (State.ON, State.STOPPING)
        if watchdog_s and powered and self.axis.time_s - self._told_s > watchdog_s:
            self._timeouts += 1
            self._fail(Fault.WATCHDOG)

    def _fail(self, fault: Fault) -> None:
        if self._state is not State.FAULT:
            self._fault = fault
        self._state = State.FAULT
        self._kept["control"] = Control.OFF

    def _stop(self, seen: Sample) -> Demand:
        if seen.velocity_rad_s == 0.0:
            self._state = State.OFF
            self._kept["control"] = Control.OFF
            return OFF
        return Demand(BRAKE)

    def _chopped(self, demand: Demand, seen: Sample, limit_a: float) -> Demand:
        """Return the demand, or the limit current in its place while the duty would drive more than that."""
        motor, (rotor_rad_s,) = self.axis.plant.parameters.motor, self.axis.plant.true_values("rotor_rad_s")
        back_emf_v = motor.torque_constant_n_m_a * rotor_rad_s * self.axis.plant.parameters.gear.ratio
        back_emf_v *= self.axis.plant.parameters.wiring.motor_sign
        driven_a = (demand.value * seen.supply_v - back_emf_v) / motor.resistance_ohm
        self._limited = abs(driven_a) > limit_a
        return Demand(CURRENT, limit_a if driven_a > 0.0 else -limit_a) if self._limited else demand
