"""One axis: takes torques, answers remote frames, sends heartbeats, disarms when nobody feeds its watchdog."""

from collections.abc import Callable
from math import isnan, pi
from struct import pack, unpack_from
from threading import RLock

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, Axis, Demand
from sim_backend.devices.can.frame import Frame, QuietNode
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

IDLE, CLOSED_LOOP = 1, 8
HEARTBEAT_S, ESTIMATES_S = 0.1, 0.01
DRV_FAULT, UNDER_VOLTAGE, CURRENT_LIMIT, MOTOR_HOT = 0x20, 0x200, 0x1000, 0x2000
WATCHDOG, ESTOP = 0x1000000, 0x2000000
UNRELEASED = 255  # so that no record of it is taken for one of hardware
_LIMIT_A = 20.0


class OdriveAxis:
    """An axis in torque control.

    Args:
        parameters: the joint.
        node_id: 0 .. 62.
        watchdog_s: of axis0.config [s]; None: not enabled.
        seed: of the plant.
    """

    def __init__(
        self, parameters: PlantParameters, node_id: int = 0, watchdog_s: float | None = 0.2, seed: int = 0
    ) -> None:
        self.axis = Axis(parameters, self, seed)
        self.lock = RLock()
        self.node = QuietNode()
        self._node_id = node_id
        self._watchdog_s = watchdog_s
        self._torque_constant_n_m_a = parameters.motor.torque_constant_n_m_a
        self._turn_rad = 2.0 * pi / parameters.gear.ratio  # of the joint, for a turn of the motor
        self._state, self._torque_n_m = IDLE, 0.0
        self._errors = self._disarmed_for = 0
        self._fed_s = self._heartbeat_s = self._estimates_s = 0.0
        self.watchdog_trips = 0
        self._answers: dict[int, Callable[[], bytes]] = {
            0x00: lambda: bytes((2, 4, 4, 58, 0, 6, 11, UNRELEASED)),
            0x03: lambda: pack("<II", self._errors, self._disarmed_for),
            0x09: self._estimates,
            0x14: lambda: pack("<ff", self._wanted_a(), self.axis.current_a),
            0x15: lambda: pack("<ff", *(2 * [self.axis.temperature_c])),
            0x17: lambda: pack("<ff", self.axis.seen.supply_v, abs(self.axis.current_a * self.axis.seen.duty)),
            0x1C: lambda: pack("<ff", self._torque_n_m, self.axis.current_a * self._torque_constant_n_m_a),
        }

    # what the threads around it call ------------------------------------------------------------------

    def advance_to(self, time_s: float) -> None:
        """Let time pass, and send what is due."""
        self.axis.advance_to(time_s)
        now_s = self.axis.time_s
        if now_s - self._heartbeat_s >= HEARTBEAT_S:
            self._heartbeat_s = now_s
            self._send(0x01, pack("<IBBBB", self._errors, self._state, 0, 1, 0))
        if now_s - self._estimates_s >= ESTIMATES_S:
            self._estimates_s = now_s
            self._send(0x09, self._estimates())

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        if frame.extended or frame.can_id >> 5 != self._node_id:
            return
        command = frame.can_id & 31
        if frame.remote:
            if command in self._answers:
                self._send(command, self._answers[command]())
            return
        self._fed_s = self.axis.time_s
        self._obey(command, frame.data)

    def report(self) -> dict[str, object]:
        """Say what the axis is about."""
        return {
            "kind": "odrive",
            "state": self._state,
            "errors": self._errors | self._disarmed_for,
            "watchdog_s": self._watchdog_s,
            "watchdog_trips": self.watchdog_trips,
        }

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:  # noqa: ARG002
        """Return what the stage does for the coming tick."""
        trip = self.axis.trip()
        wrong = trip is not None or self.axis.torque_is_disabled()
        self._errors = 0
        if wrong:  # an open safe-torque-off circuit is an emergency stop
            error = tripped(trip, MOTOR_HOT, CURRENT_LIMIT, UNDER_VOLTAGE, DRV_FAULT)
            self._errors = ESTOP if trip is None else error
            self._disarm(self._errors)
        if self._state != CLOSED_LOOP:
            return OFF
        if self._watchdog_s is not None and self.axis.time_s - self._fed_s > self._watchdog_s:
            self.watchdog_trips += 1
            self._disarm(WATCHDOG)
            return OFF
        return Demand(CURRENT, self._wanted_a())

    def _wanted_a(self) -> float:
        return max(-_LIMIT_A, min(_LIMIT_A, self._torque_n_m / self._torque_constant_n_m_a))

    def _disarm(self, reason: int) -> None:
        if self._state == CLOSED_LOOP or reason & ~WATCHDOG:
            self._disarmed_for |= reason
        self._state, self._torque_n_m = IDLE, 0.0

    # the messages ----------------------------------------------------------------------------------------

    def _obey(self, command: int, data: bytes) -> None:
        match command:
            case 0x02:
                self._disarm(ESTOP)
            case 0x07 if len(data) >= 4:
                self._go_to(unpack_from("<I", data)[0])
            case 0x0E if len(data) >= 4:
                (torque_n_m,) = unpack_from("<f", data)
                self._torque_n_m = 0.0 if isnan(torque_n_m) else torque_n_m
            case 0x18:
                self._disarmed_for = 0

    def _go_to(self, state: int) -> None:
        """A state is left alone where errors forbid it."""
        if state == IDLE:
            self._state, self._torque_n_m = IDLE, 0.0
        elif state == CLOSED_LOOP and not self._errors | self._disarmed_for and not self.axis.mode_is_refused():
            self._state = CLOSED_LOOP

    def _send(self, command: int, data: bytes) -> None:
        self.node.send(Frame(self._node_id << 5 | command, data))

    def _estimates(self) -> bytes:
        seen = self.axis.seen
        return pack("<ff", seen.position_rad / self._turn_rad, seen.velocity_rad_s / self._turn_rad)
