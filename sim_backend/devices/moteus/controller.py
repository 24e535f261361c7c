"""One controller: takes torques with a time limit, answers for its registers, has a console."""

from collections.abc import Iterator
from math import isnan, nan, pi
from struct import error, pack, unpack_from
from typing import NamedTuple

from drivers.contract import Sample
from sim_backend.devices.axis import BRAKE, CURRENT, OFF, Axis, Demand
from sim_backend.faults.script import tripped
from sim_backend.plant.parameters import PlantParameters

NOTHING = 0x50
TO_CONSOLE, FROM_CONSOLE, POLL_CONSOLE = 0x40, 0x41, 0x42
_TYPES = "bhif"
_SIZES = (1, 2, 4, 4)
FLOAT = 3
Scale = tuple[float, float, float]
_UNSET = (-0x80, -0x8000, -0x8000_0000)
_TOP = (0x7F, 0x7FFF, 0x7FFF_FFFF)
STOPPED, FAULT, POSITION, TIMEOUT, BRAKING = 0, 1, 10, 11, 15
DRIVER_FAULT, HOT, UNDER_VOLTAGE, NOT_ENABLED = 33, 38, 40, 44
VERSION = 0x010B00
SERIAL = (0x0000_0000, 0x5349_4D55, 0x4C41_5445)  # so that no record of it is taken for one of hardware
_DEFAULT_TIMEOUT_S = 0.1
_STIFFNESS, _DAMPING = 0.02, 0.001  # N m / turn, N m s / turn, at the scale of 1
_PLAIN: Scale = (1.0, 1.0, 1.0)
_TURNS: Scale = (0.01, 1e-4, 1e-5)
_SPEED: Scale = (0.1, 0.00025, 1e-5)
_TORQUE: Scale = (0.5, 0.01, 0.001)
_CURRENT: Scale = (1.0, 0.1, 0.001)
_VOLTAGE: Scale = (0.5, 0.1, 0.001)
_HEAT: Scale = (1.0, 0.1, 0.001)
_SHARE: Scale = (1 / 127, 1 / 32767, 1 / 2147483647)
_TIME: Scale = (0.01, 0.001, 1e-6)
_COMMANDS: dict[int, Scale] = {0x20: _TURNS, 0x21: _SPEED, 0x22: _TORQUE, 0x23: _SHARE, 0x24: _SHARE, 0x27: _TIME}


class Write(NamedTuple):
    """Words that were written: kind 0 .. 3 (int8, int16, int32, float)."""

    kind: int
    register: int
    value: float


class Read(NamedTuple):
    """Registers that are asked for."""

    kind: int
    register: int
    many: int


class Console(NamedTuple):
    """Text to its console, or a question for what it says."""

    is_poll: bool
    text: bytes
    most: int


def apart(data: bytes) -> Iterator[Write | Read | Console]:
    """Yield the subframes of a frame; what cannot be read ends them."""
    place = 0
    try:
        while place < len(data):
            head = data[place]
            place += 1
            if head == NOTHING:
                continue
            if head < 0x20:
                kind, count = head >> 2 & 3, head & 3
                if not count:
                    count, place = _number(data, place)
                start, place = _number(data, place)
                if head >= 0x10:
                    yield Read(kind, start, count)
                    continue
                for register in range(start, start + count):
                    yield Write(kind, register, unpack_from("<" + _TYPES[kind], data, place)[0])
                    place += _SIZES[kind]
            elif head == TO_CONSOLE:
                _, place = _number(data, place)
                length, place = _number(data, place)
                yield Console(False, data[place : place + length], 0)
                place += length
            elif head == POLL_CONSOLE:
                _, place = _number(data, place)
                most, place = _number(data, place)
                yield Console(True, b"", most)
            else:
                return
    except (IndexError, error):
        return


def in_si(write: Write, scale: Scale) -> float:
    """Return a written value; NaN for the largest negative number."""
    if write.kind == FLOAT:
        return write.value
    return nan if write.value == _UNSET[write.kind] else write.value * scale[write.kind]


def reply(read: Read, values: list[tuple[float, Scale]]) -> bytes:
    """Return the subframe that answers."""
    head = bytes((0x20 | read.kind << 2, read.many)) if read.many > 3 else bytes((0x20 | read.kind << 2 | read.many,))
    words = b"".join(_word(read.kind, value, scale) for value, scale in values)
    return head + _varuint(read.register) + words


def console_reply(text: bytes) -> bytes:
    """Return the subframe of what its console says."""
    return bytes((FROM_CONSOLE, 1, len(text))) + text


def _word(kind: int, value: float, scale: Scale) -> bytes:
    if kind == FLOAT:
        return pack("<f", value)
    word = _UNSET[kind] if isnan(value) else max(-_TOP[kind], min(_TOP[kind], round(value / scale[kind])))
    return pack("<" + _TYPES[kind], word)


def _number(data: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[place]
        place += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, place


def _varuint(value: int) -> bytes:
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes((*out, value))


class Command(NamedTuple):
    """What it was told last; turns, turns a second, N m, shares, s."""

    position: float = 0.0
    speed: float = 0.0
    torque_n_m: float = 0.0
    stiffness: float = 1.0
    damping: float = 1.0
    timeout_s: float = 0.0


class MoteusController:
    """A controller whose output is the motor's side of the joint.

    Args:
        parameters: the joint.
        servo_id: 1 .. 126.
        seed: of the plant.
    """

    def __init__(self, parameters: PlantParameters, servo_id: int = 1, seed: int = 0) -> None:
        self.axis = Axis(parameters, self, seed)
        self.servo_id = servo_id
        self._turn_rad = 2.0 * pi / parameters.gear.ratio  # of the joint, for a turn of the output
        self._torque_constant_n_m_a = parameters.motor.torque_constant_n_m_a
        self._mode, self._fault = STOPPED, 0
        self._command = Command()
        self._heard_s = 0.0
        self._configured: dict[str, float] = {"servo.timeout_mode": 12, "servo.default_timeout_s": _DEFAULT_TIMEOUT_S}
        self._typed, self._says = b"", b""
        self.watchdog_trips = 0

    def report(self) -> dict[str, object]:
        """Say what the controller is about."""
        return {"kind": "moteus", "mode": self._mode, "fault": self._fault, "watchdog_trips": self.watchdog_trips}

    def hear(self, data: bytes, wants_answer: bool) -> bytes:
        """Take the data of a frame; return those of the answer, b'' for none."""
        writes: list[Write] = []
        answer = b""
        for part in apart(data):
            if isinstance(part, Write):
                writes.append(part)
                continue
            if writes:
                self._obey(writes)
                writes = []
            answer += self._read(part) if isinstance(part, Read) else self._talk(part)
        if writes:
            self._obey(writes)
        return answer if wants_answer else b""

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:
        """Return what the stage does for the coming tick."""
        cause = self.axis.trip()
        if cause is not None or self.axis.torque_is_disabled():
            self._mode, self._fault = FAULT, tripped(cause, HOT, DRIVER_FAULT, UNDER_VOLTAGE, NOT_ENABLED)
        if self._mode == BRAKING:
            return Demand(BRAKE)
        if self._mode == POSITION and self._is_late():
            self._mode = TIMEOUT
            self.watchdog_trips += 1
        if self._mode == TIMEOUT and self._configured["servo.timeout_mode"] != STOPPED:
            return self._current(-_DAMPING * seen.velocity_rad_s / self._turn_rad)
        if self._mode != POSITION:
            return OFF
        told = self._command
        away = 0.0 if isnan(told.position) else told.position - seen.position_rad / self._turn_rad
        speed = (0.0 if isnan(told.speed) else told.speed) - seen.velocity_rad_s / self._turn_rad
        damping = min(told.damping, told.stiffness)
        return self._current(told.torque_n_m + told.stiffness * _STIFFNESS * away + damping * _DAMPING * speed)

    def _current(self, torque_n_m: float) -> Demand:
        return Demand(CURRENT, torque_n_m / self._torque_constant_n_m_a)

    def _is_late(self) -> bool:
        limit_s = self._command.timeout_s or self._configured["servo.default_timeout_s"]
        return not isnan(limit_s) and self.axis.time_s - self._heard_s > limit_s

    # the frames ------------------------------------------------------------------------------------------

    def _obey(self, writes: list[Write]) -> None:
        """Take what one frame writes: the mode, and what that takes."""
        if writes[0].register != 0x000:
            return
        told = {one.register: in_si(one, _COMMANDS.get(one.register, _PLAIN)) for one in writes[1:]}
        match int(writes[0].value):
            case 0:
                self._mode = STOPPED
                self._fault = 0
            case 10 if self._mode in (STOPPED, POSITION, BRAKING) and not self.axis.mode_is_refused():
                self._mode = POSITION
                self._heard_s = self.axis.time_s
                values = (told.get(register, default) for register, default in zip(_COMMANDS, Command(), strict=True))
                self._command = Command(*values)
            case 15 if self._mode in (STOPPED, POSITION, BRAKING):
                self._mode = BRAKING

    def _read(self, read: Read) -> bytes:
        known = self._registers()
        values = [known.get(register, (0.0, _PLAIN)) for register in range(read.register, read.register + read.many)]
        return reply(read, values)

    def _registers(self) -> dict[int, tuple[float, Scale]]:
        seen = self.axis.seen
        current_a, heat_c = self.axis.current_a, self.axis.temperature_c
        return {
            0x000: (self._mode, _PLAIN), 0x001: (seen.position_rad / self._turn_rad, _TURNS),
            0x002: (seen.velocity_rad_s / self._turn_rad, _SPEED),
            0x003: (current_a * self._torque_constant_n_m_a, _TORQUE), 0x004: (current_a, _CURRENT),
            0x005: (0.0, _CURRENT), 0x00A: (nan, _HEAT), 0x00D: (seen.supply_v, _VOLTAGE), 0x00E: (heat_c, _HEAT),
            0x00F: (self._fault, _PLAIN), 0x101: (VERSION, _PLAIN),
            0x120: (SERIAL[0], _PLAIN), 0x121: (SERIAL[1], _PLAIN), 0x122: (SERIAL[2], _PLAIN),
        }  # fmt: skip

    def _talk(self, part: Console) -> bytes:
        if not part.is_poll:
            self._typed += part.text
            *lines, self._typed = self._typed.split(b"\n")
            for line in lines:
                self._says += self._answered(line.decode("ascii", "replace").split()) + b"\r\n"
            return b""
        said, self._says = self._says[: part.most], self._says[part.most :]
        return console_reply(said)

    def _answered(self, words: list[str]) -> bytes:
        match words:
            case ["conf", "get", name] if name in self._configured:
                return f"{self._configured[name]:g}".encode("ascii")
            case ["conf", "set", name, value] if name in self._configured:
                try:
                    self._configured[name] = float(value)
                except ValueError:
                    return b"ERR error setting"
                return b"OK"
        return b"ERR unknown command"
