"""One X servo: answers packets, closes its modes, stops when its bus is silent."""

from math import copysign, pi

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, VOLTAGE, Axis, Demand
from sim_backend.devices.dynamixel.memory import EEPROM, GOALS, READ_ONLY, Kind, Memory
from sim_backend.devices.dynamixel.packets import EVERYBODY, Instruction, status
from sim_backend.devices.servos.position_hold import PositionHold, count_rad
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

SIMULATED_FIRMWARE = 255
_REVOLUTION = 4096
_VELOCITY_RAD_S = 0.229 * 2.0 * pi / 60.0
_REBOOT_S = 0.05
FAILED, UNKNOWN_INSTRUCTION, OUT_OF_RANGE, NO_ACCESS, ALERT = 1, 2, 4, 7, 0x80
INPUT_VOLTAGE, OVERHEATING, ELECTRICAL_SHOCK, OVERLOAD = 1, 4, 16, 32
TORQUE, ERROR, WATCHDOG, MODE = 64, 70, 98, 11
TRIPPED = 0xFF
_CURRENT, _VELOCITY, _PWM = 0, 1, 16


class XServo:
    """A servo whose output shaft is the motor's side of the joint.

    Args:
        parameters: the joint; its encoder has 4096 counts.
        kind: of model.
        servo_id: 0 .. 252.
        firmware: its version; 255 says that it is simulated.
        seed: of the plant.
    """

    def __init__(
        self, parameters: PlantParameters, kind: Kind, servo_id: int = 1, firmware: int = SIMULATED_FIRMWARE,
        seed: int = 0,
    ) -> None:  # fmt: skip
        self.axis = Axis(parameters, self, seed)
        self.memory = Memory(kind, servo_id, firmware)
        self.watchdog_trips = 0
        self._kind = kind
        self._hold = PositionHold(parameters)
        self._count_rad = count_rad(parameters)
        self._heard_s = self._deaf_until_s = 0.0

    @property
    def servo_id(self) -> int:
        """Its id."""
        return self.memory.get(7)

    def report(self) -> dict[str, object]:
        """Say what the servo is about."""
        return {
            "kind": "dynamixel",
            "torque_enabled": bool(self.memory.get(TORQUE)),
            "hardware_error": self.memory.get(ERROR),
            "watchdog": self.memory.get(WATCHDOG),
            "watchdog_trips": self.watchdog_trips,
        }

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:
        """Return what the stage does for the coming tick."""
        memory = self.memory
        if memory.get(TORQUE):
            self._watch()
        trip = self.axis.trip()
        if trip is not None or self.axis.torque_is_disabled():
            memory.put(
                ERROR, "B", memory.get(ERROR) | tripped(trip, OVERHEATING, OVERLOAD, INPUT_VOLTAGE, ELECTRICAL_SHOCK)
            )
            memory.put(TORQUE, "B", 0)
        if not memory.get(TORQUE):
            return OFF
        if memory.get(WATCHDOG) == TRIPPED:
            return Demand(VOLTAGE, 0.0)
        return self._controlled(memory.get(MODE), seen)

    def _watch(self) -> None:
        steps = self.memory.get(WATCHDOG, "b")
        if steps > 0 and self.axis.time_s - self._heard_s > steps * 0.02:
            self.memory.put(WATCHDOG, "B", TRIPPED)
            self.watchdog_trips += 1

    def _controlled(self, mode: int, seen: Sample) -> Demand:
        memory = self.memory
        duty_limit = memory.get(36, "H") / 885.0
        if mode == _PWM:
            return Demand(VOLTAGE, _within(memory.get(100, "h") / 885.0, duty_limit))
        limit_a = memory.get(38, "H") * (self._kind.current_a or 0.00269)
        if mode == _CURRENT:
            return Demand(CURRENT, _within(memory.get(102, "h") * self._kind.current_a, limit_a))
        if mode == _VELOCITY:
            target_rad_s = memory.get(104, "i") * _VELOCITY_RAD_S * self._count_rad * _REVOLUTION / (2.0 * pi)
            return Demand(VOLTAGE, _within(0.2 * (target_rad_s - seen.velocity_rad_s), duty_limit))
        target_rad = (memory.get(116, "i") - memory.get(20, "i")) * self._count_rad
        return Demand(CURRENT, _within(self._hold.current_a(target_rad, seen), limit_a))

    # the packets -----------------------------------------------------------------------------------------

    def hear(self, request: Instruction, time_s: float) -> bytes:
        """Take a packet, whoever it is for."""
        if time_s < self._deaf_until_s:
            return b""
        self._heard_s = time_s
        if request.servo not in (self.servo_id, EVERYBODY):
            return b""
        self._measure()
        match request.code:
            case 0x01:
                return self._status(self.memory.read(0, 2) + self.memory.read(6, 1))
            case 0x02 if len(request.parameters) == 4:
                return self._read(*_piece(request.parameters))
            case 0x03 if len(request.parameters) > 2:
                return self._written(int.from_bytes(request.parameters[:2], "little"), request.parameters[2:], request)
            case 0x08:
                return self._reboot(time_s)
            case 0x82 if self.servo_id in request.parameters[4:]:
                return self._read(*_piece(request.parameters[:4]))
            case 0x83:
                self._take_share(request.parameters)
        known = request.code in (0x82, 0x83)
        return b"" if known or request.servo == EVERYBODY else self._status(b"", UNKNOWN_INSTRUCTION)

    def _read(self, address: int, size: int) -> bytes:
        if not self.memory.holds(address, size):
            return self._status(b"", NO_ACCESS)
        return self._status(self.memory.read(address, size))

    def _written(self, address: int, data: bytes, request: Instruction) -> bytes:
        error = self._write(address, data)
        answers = self.memory.get(68) == 2 and request.servo != EVERYBODY
        return self._status(b"", error) if answers else b""

    def _take_share(self, parameters: bytes) -> None:
        """Sync write: address, size, then id and data of each servo."""
        address, size = _piece(parameters[:4])
        for start in range(4, len(parameters), size + 1):
            if parameters[start] == self.servo_id:
                self._write(address, parameters[start + 1 : start + 1 + size])

    def _write(self, address: int, data: bytes) -> int:
        """Write where that is allowed; return the error, 0 for none."""
        memory = self.memory
        if not memory.holds(address, len(data)):
            return NO_ACCESS
        places = memory.places(address, len(data))
        if any(place in span for place in places for span in READ_ONLY):
            return NO_ACCESS
        if memory.get(TORQUE) and any(place in EEPROM for place in places):
            return NO_ACCESS
        if memory.get(WATCHDOG) == TRIPPED and any(place in GOALS for place in places):
            return OUT_OF_RANGE
        if address == MODE and (self.axis.mode_is_refused() or data[0] not in self._kind.modes):
            return NO_ACCESS if self.axis.mode_is_refused() else OUT_OF_RANGE
        if address == TORQUE and data[0] and memory.get(ERROR):
            return FAILED
        memory.write(address, data)
        if address == MODE:
            self._reset_goals()
        return 0

    def _reset_goals(self) -> None:
        """A change of mode sets every goal to rest."""
        self.memory.put(100, "h", 885)
        for address, letter in ((102, "h"), (104, "i")):
            self.memory.put(address, letter, 0)
        self.memory.put(116, "i", self.axis.counts() + self.memory.get(20, "i"))

    def _reboot(self, time_s: float) -> bytes:
        answer = self._status()
        self.memory.restart()
        self._deaf_until_s = time_s + _REBOOT_S
        return answer

    def _status(self, data: bytes = b"", error: int = 0) -> bytes:
        return status(self.servo_id, error | (ALERT if self.memory.get(ERROR) else 0), data)

    def _measure(self) -> None:
        """Bring the measured items up to date."""
        seen, memory, current_a = self.axis.seen, self.memory, self.axis.current_a
        step_a = self._kind.current_a
        load = current_a / step_a if step_a else 1000.0 * abs(seen.duty) * copysign(1.0, current_a)
        memory.put(124, "h", round(seen.duty * 885.0))
        memory.put(126, "h", round(_within(load, 32767.0)))
        memory.put(128, "i", round(self.axis.counts_per_s() * 2.0 * pi / _REVOLUTION / _VELOCITY_RAD_S))
        memory.put(132, "i", self.axis.counts() + memory.get(20, "i"))
        memory.put(120, "H", round(self.axis.time_s * 1e3) % 32768)
        memory.put(144, "H", round(seen.supply_v * 10.0))
        memory.put(146, "B", round(self.axis.temperature_c))


def _piece(parameters: bytes) -> tuple[int, int]:
    """Return address and size."""
    return int.from_bytes(parameters[:2], "little"), int.from_bytes(parameters[2:4], "little")


def _within(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
