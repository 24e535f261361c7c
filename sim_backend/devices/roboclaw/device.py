"""The RoboClaw: answers packets, drives motor 1. Nothing is wired to motor 2."""

from collections import deque
from math import exp
from struct import pack, unpack
from threading import RLock
from typing import NamedTuple

from drivers.contract import Sample
from sim_backend.devices.axis import OFF, TICK_S, VOLTAGE, Axis, Demand, Device
from sim_backend.devices.roboclaw.channel import FULL_DUTY, WARM_C, Channel, Counter, Flag, Settings, flag_of
from sim_backend.devices.roboclaw.commands import ACKNOWLEDGED, COMMANDS
from sim_backend.devices.roboclaw.handlers import handlers_of
from sim_backend.plant.parameters import PlantParameters

VERSION = b"USB Roboclaw 2x15a v4.1.34 simulated\n\0"  # so that no record of it is taken for one of hardware
SPEED_WINDOW_S = 1.0 / 300.0  # of commands 30, 31
MEASURED = {"encoder": {"speed_window_s": SPEED_WINDOW_S}}
_SPEED_LAG_S = 0.02  # of commands 18, 19, which the manual calls filtered and does not say how
_SPEED_SHARE = 1.0 - exp(-TICK_S / _SPEED_LAG_S)

Values = tuple[int, ...]


def _of_byte(byte: int) -> int:
    register = byte << 8
    for _ in range(8):
        register = (register << 1) ^ 0x1021 if register & 0x8000 else register << 1
    return register & 0xFFFF


_TABLE = tuple(_of_byte(byte) for byte in range(256))


def crc16(data: bytes) -> int:
    """Return the CRC of some bytes."""
    register = 0
    for byte in data:
        register = ((register << 8) & 0xFFFF) ^ _TABLE[(register >> 8) ^ byte]
    return register


LONGEST_GAP_S = 0.010
ADDRESSES = range(0x80, 0x88)
_HEAD = 2  # address, command
_CRC = 2


class Request(NamedTuple):
    """A valid packet.

    Attributes:
        head: address and command, which the CRC of an answer covers too.
    """

    head: bytes
    command: int
    values: tuple[int, ...]


class PacketReader:
    """Collects bytes, and drops what is not a packet.

    A pause of more than 10 ms ends a packet. After anything invalid the device hears nothing until such a pause: there
    is no other way to tell where the next packet begins.

    Args:
        addresses: to which it listens; over USB a RoboClaw takes any of 0x80 .. 0x87.
    """

    def __init__(self, addresses: frozenset[int]) -> None:
        self._addresses = addresses
        self._buffer = b""
        self._deaf = False
        self._last_s = -LONGEST_GAP_S

    def forget(self) -> None:
        """Drop half a packet."""
        self._buffer = b""
        self._deaf = False

    def feed(self, data: bytes, time_s: float) -> list[Request]:
        """Return the packets that are complete with bytes that arrived at a time [s]."""
        if time_s - self._last_s > LONGEST_GAP_S:
            self.forget()
        self._last_s = time_s
        requests = []
        self._buffer += data
        while not self._deaf and (request := self._take()):
            requests.append(request)
        if self._deaf:
            self._buffer = b""
        return requests

    def _take(self) -> Request | None:
        buffer = self._buffer
        if (buffer and buffer[0] not in self._addresses) or (len(buffer) >= _HEAD and buffer[1] not in COMMANDS):
            self._deaf = True
            return None
        if len(buffer) < _HEAD:
            return None
        command = COMMANDS[buffer[1]]
        end = _HEAD + command.payload_length
        length = end if command.reply else end + _CRC
        if len(buffer) < length:
            return None
        if not command.reply and crc16(buffer[:end]) != int.from_bytes(buffer[end:length]):
            self._deaf = True
            return None
        self._buffer = buffer[length:]
        return Request(buffer[:_HEAD], buffer[1], unpack(">" + command.payload, buffer[_HEAD:end]))


class RoboClaw(Device):
    """One device on a serial line.

    Args:
        parameters: the joint on motor 1.
        address: 0x80 .. 0x87.
        usb: over USB every address is its own.
        seed: of the plant.
    """

    def __init__(self, parameters: PlantParameters, address: int = 0x80, usb: bool = False, seed: int = 0) -> None:
        self.axis = Axis(parameters, self, seed)
        self.lock = RLock()
        self.settings = Settings()
        self._packets = PacketReader(frozenset(ADDRESSES) if usb else frozenset({address}))
        self._channels = (Channel(), Channel())
        self._counters = (Counter(), Counter())
        self._speed = 0.0  # filtered [pulses/s]
        self._past_counts = deque([0], maxlen=round(1.0 / TICK_S))
        self._heard_s = 0.0
        self._timeouts = 0
        self._silent = False
        self._handlers = handlers_of(self)

    # what the threads around it call -----------------------------------------------------------------

    def connect(self) -> None:
        """Forget half a packet."""
        self._packets.forget()

    def receive(self, data: bytes, time_s: float) -> bytes:
        """Take bytes; return the answers."""
        self._heard_s = time_s
        self._silent = False
        self._counters[0].follow(self.axis.counts())
        return b"".join(self._answer(request) for request in self._packets.feed(data, time_s))

    def report(self) -> dict[str, object]:
        """Say what the drive is about."""
        return {
            "kind": "roboclaw",
            "status": int(self._status()),
            "watchdog_s": self.settings.serial_timeout * 0.1,
            "watchdog_trips": self._timeouts,
        }

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:  # noqa: ARG002
        """Return the duty of motor 1 for the coming tick."""
        counts, raw = self.axis.counts(), self.axis.counts_per_s()
        self._counters[0].follow(counts)
        self._past_counts.append(counts)
        self._speed += (raw - self._speed) * _SPEED_SHARE
        self._watch()
        if self.axis.trip() is not None or self.axis.torque_is_disabled():
            self._stop()
            return OFF
        limit_a = self.settings.current_limits[0][0] * 0.01
        duty = self._channels[0].duty(raw, self.settings.velocity_pids[0], self.axis.current_a, limit_a)
        return Demand(VOLTAGE, duty)

    def _watch(self) -> None:
        timeout = self.settings.serial_timeout
        if timeout and not self._silent and self.axis.time_s - self._heard_s > timeout * 0.1:
            self._silent = True
            self._timeouts += 1
            self._stop()

    def _stop(self) -> None:
        for channel in self._channels:
            channel.stop()

    # the packets -----------------------------------------------------------------------------------------

    def _answer(self, request: Request) -> bytes:
        result = self._handlers[request.command](*request.values)
        layout = COMMANDS[request.command].reply
        if not layout:
            return ACKNOWLEDGED
        data = VERSION if layout == "text" else pack(">" + layout, *result)
        return data + crc16(request.head + data).to_bytes(2)

    def read_status(self) -> Values:
        """Command 90."""
        return (int(self._status()),)

    def read_count(self, motor: int) -> Values:
        """Commands 16, 17."""
        return self._counters[motor].read()

    def read_counts(self) -> Values:
        """Command 78."""
        return self._counters[0].value(), self._counters[1].value()

    def set_count(self, motor: int, value: int) -> Values:
        """Commands 20, 22, 23."""
        self._counters[motor].set(value)
        return ()

    def read_speeds(self, raw: bool) -> Values:
        """Command 79, and what 18, 19 tell [pulses/s]."""
        return round(self.axis.counts_per_s() if raw else self._speed), 0

    def read_mean_speeds(self) -> Values:
        """Command 108: pulses of the last second."""
        return self.axis.counts() - self._past_counts[0], 0

    def read_speed(self, motor: int, raw: bool) -> Values:
        """Commands 18, 19, 30, 31: speed [pulses/s] and 1 for backward."""
        speed = self.read_speeds(raw)[motor]
        return speed, int(speed < 0)

    def drive(self, motor: int, duty: int, acceleration: int | None = None) -> Values:
        """Commands 32 .. 34, 52 .. 54."""
        self._channels[motor].drive(duty, acceleration)
        return ()

    def turn(self, motor: int, speed: int) -> Values:
        """Commands 35 .. 37."""
        self._channels[motor].turn(speed)
        return ()

    def read_duties(self) -> Values:
        """Command 48: what the stage applies to motor 1; what motor 2 was told."""
        unwired = self._channels[1].duty(0.0, self.settings.velocity_pids[1], 0.0, 1.0)
        return round(self.axis.seen.duty * FULL_DUTY), round(unwired * FULL_DUTY)

    def read_currents(self) -> Values:
        """Command 49 [10 mA]."""
        return _short(round(self.axis.current_a * 100.0)), 0

    def read_main_voltage(self) -> Values:
        """Command 24 [0.1 V]."""
        return (round(self.axis.seen.supply_v * 10.0),)

    def read_temperature(self) -> Values:
        """Commands 82, 83 [0.1 degC]."""
        return (round(self.axis.temperature_c * 10.0),)

    def restore_defaults(self) -> Values:
        """Command 80."""
        self._stop()
        self.settings = Settings()
        return ()

    def _status(self) -> Flag:
        status = Flag(0)
        trip = self.axis.trip()
        if trip is not None:
            status |= flag_of(trip)
        if self.axis.torque_is_disabled():
            status |= Flag.E_STOP
        if self._channels[0].limited:
            status |= Flag.MOTOR_1_CURRENT_WARNING
        if self.axis.temperature_c >= WARM_C:
            status |= Flag.TEMPERATURE_WARNING
        if self.axis.seen.supply_v * 10.0 < self.settings.main_limits[0]:
            status |= Flag.MAIN_LOW_WARNING
        return status


def _short(value: int) -> int:
    return max(-32768, min(32767, value))
