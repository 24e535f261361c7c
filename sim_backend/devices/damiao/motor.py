"""One actuator: takes commands of the MIT protocol, answers each, keeps registers, stops when nobody talks to it."""

from struct import pack, unpack

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.mit.motor import Command, MitMotor
from sim_backend.devices.mit.short_frames import Top, command_of, motion_of
from sim_backend.faults.script import Trip, tripped
from sim_backend.plant.parameters import PlantParameters

SOFTWARE = 0xFFFFFFFF  # so that no record of it is taken for one of hardware
DISABLED, ENABLED = 0, 1
UNDER_VOLTAGE, OVER_CURRENT, HOT, LOST, OVERLOAD = 9, 10, 12, 13, 14
TIMEOUT, CONTROL_MODE, P_MAX, V_MAX, T_MAX = 9, 10, 21, 22, 23
FLOATS = frozenset({P_MAX, V_MAX, T_MAX, 20})
_STEP_S = 50e-6
_ROTOR_C = 25


class DamiaoMotor(MitMotor):
    """An actuator with registers.

    Args:
        parameters: the joint.
        motor_id: to which it listens.
        ranges: of position [rad], speed [rad/s] and torque [N m] in its frames.
        seed: of the plant.
        feedback_id: with which it answers.
    """

    def __init__(
        self, parameters: PlantParameters, motor_id: int, ranges: Top, seed: int = 0, feedback_id: int = 0x11
    ) -> None:
        super().__init__(parameters, ranges[2], seed)
        self._motor_id, self._feedback_id = motor_id, feedback_id
        self._registers: dict[int, float] = {
            7: feedback_id, 8: motor_id, TIMEOUT: 0, CONTROL_MODE: 1, 14: SOFTWARE, 20: 1.0,
            P_MAX: ranges[0], V_MAX: ranges[1], T_MAX: ranges[2],
        }  # fmt: skip
        self._error = DISABLED

    @property
    def timeout_s(self) -> float:
        """As of its register [s]."""
        return self._registers[TIMEOUT] * _STEP_S

    def take(self, frame: Frame) -> bool:
        """Obey a command, or read and write a register."""
        data = frame.data
        if frame.extended:
            return False
        if frame.can_id == self._motor_id:
            self._obey(data)
            self._answer()
            return True
        if frame.can_id == 0x7FF and data[0] + 256 * data[1] == self._motor_id:
            self._register(data)
            return True
        return False

    def trip(self, cause: Trip | None) -> None:
        """Keep its error."""
        self._error = tripped(cause, HOT, OVER_CURRENT, UNDER_VOLTAGE, OVERLOAD)

    def lost(self) -> None:
        """Keep that nobody talks to it."""
        self._error = LOST

    def report(self) -> dict[str, object]:
        """Say what the actuator is about."""
        return {
            "kind": "damiao",
            "state": self._state,
            "watchdog_s": self.timeout_s,
            "watchdog_trips": self.watchdog_trips,
        }

    @property
    def _state(self) -> int:
        return ENABLED if self.is_on else self._error

    @property
    def _top(self) -> Top:
        return self._registers[P_MAX], self._registers[V_MAX], self._registers[T_MAX]

    def _obey(self, data: bytes) -> None:
        if data[:7] == b"\xff" * 7:
            self.command = Command()
            match data[7]:
                case 0xFC if not self._error and not self.axis.mode_is_refused():
                    self.is_on = True
                case 0xFD:
                    self.is_on = False
                case 0xFB:
                    self._error = DISABLED
        elif self.is_on:
            self.command = command_of(data, self._top)

    def _answer(self) -> None:
        head = bytes((self._state << 4 | self._motor_id & 0x0F,))
        data = head + motion_of(self, self._top) + bytes((_ROTOR_C, round(self.axis.temperature_c)))
        self.node.send(Frame(self._feedback_id, data))

    def _register(self, data: bytes) -> None:
        what, number = data[2], data[3]
        if what == 0xCC:
            self._answer()
            return
        if number not in self._registers or what not in (0x33, 0x55):
            return
        if what == 0x55 and not self.is_on:
            self._registers[number] = unpack("<f" if number in FLOATS else "<I", data[4:])[0]
        value = self._registers[number]
        packed = pack("<f", value) if number in FLOATS else pack("<I", int(value))
        self.node.send(Frame(self._feedback_id, data[:4] + packed))
