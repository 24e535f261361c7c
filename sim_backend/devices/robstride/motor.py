"""One actuator: takes commands, answers each, keeps parameters, stops when nobody talks to it."""

from struct import pack, unpack

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.mit.motor import Command, MitMotor, number, word_of
from sim_backend.faults.script import Trip, tripped
from sim_backend.plant.parameters import PlantParameters

SERIAL = b"SIMULATE"  # so that no record of it is taken for one of hardware
VERSION = bytes((0, 4, 2, 6))
UNDER_VOLTAGE, OVER_CURRENT, HOT, OVERLOAD = 0x01, 0x02, 0x04, 0x10
RESET, RUN = 0, 2
RUN_MODE, TORQUE_LIMIT, POSITION, SUPPLY, TIMEOUT = 0x7005, 0x700B, 0x7019, 0x701C, 0x7028
_STIFFNESS_MAX, _DAMPING_MAX = 500.0, 5.0
_STEP_S = 50e-6


class RobstrideMotor(MitMotor):
    """An actuator with parameters.

    Args:
        parameters: the joint.
        motor_id: its CAN id.
        ranges: of position [rad], speed [rad/s] and torque [N m] in its frames.
        seed: of the plant.
    """

    def __init__(
        self, parameters: PlantParameters, motor_id: int, ranges: tuple[float, float, float], seed: int = 0
    ) -> None:
        super().__init__(parameters, ranges[2], seed)
        self._id, self._top = motor_id, ranges
        self._faults, self._host = 0, 0xFD
        self._written: dict[int, int] = {RUN_MODE: 0, TIMEOUT: 0}

    @property
    def timeout_s(self) -> float:
        """As of its parameter [s]."""
        return self._written[TIMEOUT] * _STEP_S

    def take(self, frame: Frame) -> bool:
        """Obey a frame of its protocol."""
        if not frame.extended or frame.can_id & 0xFF != self._id:
            return False
        kind, extra, data = frame.can_id >> 24, frame.can_id >> 8 & 0xFFFF, frame.data
        if kind != 1:  # of a command, these are the torque
            self._host = extra & 0xFF
        match kind:
            case 0:
                self.node.send(Frame(self._id << 8 | 0xFE, SERIAL, extended=True))
            case 1:
                self._move(extra, data)
                self._answer()
            case 3:
                if not self._faults and not self.axis.mode_is_refused():
                    self.is_on, self.command = True, Command()
                self._answer()
            case 4:
                self._stop(data)
            case 17:
                self._read(int.from_bytes(data[:2], "little"))
            case 18:
                self._write(int.from_bytes(data[:2], "little"), data)
                self._answer()
        return True

    def trip(self, cause: Trip | None) -> None:
        """Keep its fault."""
        self._faults |= tripped(cause, HOT, OVER_CURRENT, UNDER_VOLTAGE, OVERLOAD)

    def lost(self) -> None:
        """It goes to its reset mode, and keeps no fault of it."""

    def report(self) -> dict[str, object]:
        """Say what the actuator is about."""
        return {
            "kind": "robstride",
            "is_on": self.is_on,
            "faults": self._faults,
            "watchdog_s": self.timeout_s,
            "watchdog_trips": self.watchdog_trips,
        }

    # the frames ------------------------------------------------------------------------------------------

    def _move(self, torque: int, data: bytes) -> None:
        if not self.is_on:
            return
        position, speed, stiffness, damping = unpack(">HHHH", data)
        top = self._top
        self.command = Command(
            number(position, 16, -top[0], top[0]), number(speed, 16, -top[1], top[1]),
            number(stiffness, 16, 0.0, _STIFFNESS_MAX), number(damping, 16, 0.0, _DAMPING_MAX),
            number(torque, 16, -top[2], top[2]),
        )  # fmt: skip

    def _stop(self, data: bytes) -> None:
        self.is_on = False
        if data[0] == 1:
            self._faults = 0
        if data[1] == 0xC4:
            self._send(2, self._state, b"\x00\xc4\x56" + VERSION + b"\x00")
        else:
            self._answer()

    def _read(self, parameter: int) -> None:
        value = {
            RUN_MODE: pack("<I", self._written[RUN_MODE]),
            TORQUE_LIMIT: pack("<f", self._top[2]),
            POSITION: pack("<f", self.position_rad),
            SUPPLY: pack("<f", self.axis.seen.supply_v),
            TIMEOUT: pack("<I", self._written[TIMEOUT]),
        }.get(parameter)
        head = parameter.to_bytes(2, "little") + bytes(2)
        self._send(17, 0 if value else 1, head + (value or bytes(4)))

    def _write(self, parameter: int, data: bytes) -> None:
        if parameter == TIMEOUT or (parameter == RUN_MODE and not self.is_on):
            self._written[parameter] = int.from_bytes(data[4 : 8 if parameter == TIMEOUT else 5], "little")

    @property
    def _state(self) -> int:
        return (RUN if self.is_on else RESET) << 6 | self._faults

    def _answer(self) -> None:
        position, speed, torque = self._top
        self._send(2, self._state, pack(
            ">HHHH", word_of(self.position_rad, 16, -position, position), word_of(self.speed_rad_s, 16, -speed, speed),
            word_of(self.torque_n_m, 16, -torque, torque), round(10.0 * self.axis.temperature_c),
        ))  # fmt: skip

    def _send(self, kind: int, state: int, data: bytes) -> None:
        self.node.send(Frame(kind << 24 | state << 16 | self._id << 8 | self._host, data, extended=True))
