"""One actuator: takes commands of the MIT protocol, answers each, keeps registers, stops when nobody talks to it."""

from collections.abc import Callable
from math import isnan
from struct import pack, unpack
from threading import RLock

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, Axis, Demand
from sim_backend.devices.can.frame import Frame
from sim_backend.faults.script import OverCurrent, OverTemperature, SupplyLost, Trip
from sim_backend.plant.parameters import PlantParameters

SOFTWARE = 0xFFFFFFFF  # so that no record of it is taken for one of hardware
DISABLED, ENABLED = 0, 1
UNDER_VOLTAGE, OVER_CURRENT, HOT, LOST, OVERLOAD = 9, 10, 12, 13, 14
TIMEOUT, CONTROL_MODE, P_MAX, V_MAX, T_MAX = 9, 10, 21, 22, 23
FLOATS = frozenset({P_MAX, V_MAX, T_MAX, 20})
_STIFFNESS_MAX, _DAMPING_MAX = 500.0, 5.0
_STEP_S = 50e-6
_DEFAULT_C = 25


class _Node:
    """The actuator's place on the bus."""

    def __init__(self) -> None:
        self.send: Callable[[Frame], None] = lambda _frame: None

    def boot(self) -> None:
        """It says nothing at power-up."""


class DamiaoMotor:
    """An actuator whose output is the motor's side of the joint.

    Args:
        parameters: the joint.
        motor_id: to which it listens.
        feedback_id: with which it answers.
        ranges: of position [rad], speed [rad/s] and torque [N m] in its frames.
        seed: of the plant.
    """

    def __init__(
        self, parameters: PlantParameters, motor_id: int, feedback_id: int, ranges: tuple[float, float, float],
        seed: int = 0,
    ) -> None:  # fmt: skip
        self.axis = Axis(parameters, self, seed)
        self.lock = RLock()
        self.node = _Node()
        self._motor_id, self._feedback_id = motor_id, feedback_id
        self._ratio = parameters.gear.ratio
        self._torque_constant_n_m_a = parameters.motor.torque_constant_n_m_a
        self._registers: dict[int, float] = {
            7: feedback_id, 8: motor_id, TIMEOUT: 0, CONTROL_MODE: 1, 14: SOFTWARE, 20: 1.0,
            P_MAX: ranges[0], V_MAX: ranges[1], T_MAX: ranges[2],
        }  # fmt: skip
        self._state = DISABLED
        self._demand = (0.0, 0.0, 0.0, 0.0, 0.0)  # position, speed, stiffness, damping, torque
        self._heard_s = 0.0
        self._torque_n_m = 0.0
        self.watchdog_trips = 0

    # what the threads around it call ------------------------------------------------------------------

    def advance_to(self, time_s: float) -> None:
        """Let time pass."""
        self.axis.advance_to(time_s)

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        if frame.remote or len(frame.data) != 8:
            return
        if frame.can_id == self._motor_id:
            self._heard_s = self.axis.time_s
            self._obey(frame.data)
            self._answer()
        elif frame.can_id == 0x7FF and frame.data[0] + 256 * frame.data[1] == self._motor_id:
            self._heard_s = self.axis.time_s
            self._register(frame.data)

    def report(self) -> dict[str, object]:
        """Say what the actuator is about."""
        return {
            "kind": "damiao",
            "state": self._state,
            "watchdog_s": self._registers[TIMEOUT] * _STEP_S,
            "watchdog_trips": self.watchdog_trips,
        }

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:
        """Return what the stage does for the coming tick."""
        trip = self.axis.trip()
        if trip is not None or self.axis.torque_is_disabled():
            self._state = _state_of(trip)
        timeout_s = self._registers[TIMEOUT] * _STEP_S
        if self._state == ENABLED and timeout_s and self.axis.time_s - self._heard_s > timeout_s:
            self._state = LOST
            self.watchdog_trips += 1
        if self._state != ENABLED:
            self._torque_n_m = 0.0
            return OFF
        position, speed, stiffness, damping, torque = self._demand
        torque += stiffness * (position - seen.position_rad * self._ratio)
        torque += damping * (speed - seen.velocity_rad_s * self._ratio)
        limit = self._registers[T_MAX]
        self._torque_n_m = max(-limit, min(limit, torque))
        return Demand(CURRENT, self._torque_n_m / self._torque_constant_n_m_a)

    # the frames ------------------------------------------------------------------------------------------

    def _obey(self, data: bytes) -> None:
        if data[:7] == b"\xff" * 7:
            self._command(data[7])
        elif self._state == ENABLED:
            bits = int.from_bytes(data, "big")
            top = self._registers
            self._demand = (
                _number(bits >> 48, 16, -top[P_MAX], top[P_MAX]),
                _number(bits >> 36 & 0xFFF, 12, -top[V_MAX], top[V_MAX]),
                _number(bits >> 24 & 0xFFF, 12, 0.0, _STIFFNESS_MAX),
                _number(bits >> 12 & 0xFFF, 12, 0.0, _DAMPING_MAX),
                _number(bits & 0xFFF, 12, -top[T_MAX], top[T_MAX]),
            )

    def _command(self, code: int) -> None:
        self._demand = (0.0, 0.0, 0.0, 0.0, 0.0)
        match code:
            case 0xFC if self._state == DISABLED and not self.axis.mode_is_refused():
                self._state = ENABLED
            case 0xFD if self._state == ENABLED:
                self._state = DISABLED
            case 0xFB if self._state not in (DISABLED, ENABLED):
                self._state = DISABLED

    def _answer(self) -> None:
        seen, top = self.axis.seen, self._registers
        position = _bits(seen.position_rad * self._ratio, 16, -top[P_MAX], top[P_MAX])
        speed = _bits(seen.velocity_rad_s * self._ratio, 12, -top[V_MAX], top[V_MAX])
        current_a = 0.0 if isnan(seen.current_a) else seen.current_a
        torque = _bits(current_a * self._torque_constant_n_m_a, 12, -top[T_MAX], top[T_MAX])
        temperature = _DEFAULT_C if isnan(seen.temperature_c) else round(seen.temperature_c)
        head = self._state << 4 | self._motor_id & 0x0F
        word = head << 56 | position << 40 | speed << 28 | torque << 16 | _DEFAULT_C << 8 | temperature
        self.node.send(Frame(self._feedback_id, word.to_bytes(8, "big")))

    def _register(self, data: bytes) -> None:
        what, number = data[2], data[3]
        if what == 0xCC:
            self._answer()
            return
        if number not in self._registers or what not in (0x33, 0x55):
            return
        if what == 0x55 and self._state != ENABLED:
            self._registers[number] = unpack("<f" if number in FLOATS else "<I", data[4:])[0]
        value = self._registers[number]
        packed = pack("<f", value) if number in FLOATS else pack("<I", int(value))
        self.node.send(Frame(self._feedback_id, data[:4] + packed))


def _number(word: int, bits: int, low: float, high: float) -> float:
    return low + word * (high - low) / ((1 << bits) - 1)


def _bits(value: float, bits: int, low: float, high: float) -> int:
    return round((max(low, min(high, value)) - low) * ((1 << bits) - 1) / (high - low))


def _state_of(trip: Trip | None) -> int:
    """Return the state; a supply that a hand has cut is a voltage that is too low."""
    if isinstance(trip, OverTemperature):
        return HOT
    if isinstance(trip, OverCurrent):
        return OVER_CURRENT
    return UNDER_VOLTAGE if trip is None or isinstance(trip, SupplyLost) else OVERLOAD
