"""Wires of virtual time: what drivers open in place of a serial port or a CAN bus, a simulated device behind it."""

from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest import mock

import can
from pymodbus.framer import FramerRTU

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.modbus.own_drive import OwnDrive
from sim_backend.devices.modbus.register_file import Refused
from tests.commission.virtual_time import TIME

_BYTE_S, _FRAME_S, _LATENCY_S = 10.0 / 115200.0, 130e-6, 2e-4
_WAIT_S = 1e-3


class VirtualWire:
    """A device whose time is the virtual one, from the moment that it is made."""

    def __init__(self, device: Any) -> None:
        self.device = device
        self._origin_s = TIME.now()

    def catch_up(self) -> float:
        """Bring the device to the present; its time [s]."""
        now_s = TIME.now() - self._origin_s
        self.device.advance_to(now_s)
        return now_s


class SerialWire:
    """A serial port as pyserial offers it.

    Args:
        wire: the device.
        answer: from the bytes that came to those that go back.
    """

    is_open = True

    def __init__(self, wire: VirtualWire, answer: Any) -> None:
        self._wire, self._answer, self._waiting = wire, answer, bytearray()
        self.timeout = 0.05
        self.inter_byte_timeout = 0.0

    @property
    def in_waiting(self) -> int:
        return len(self._waiting)

    def write(self, data: bytes) -> int:
        TIME.advance(_BYTE_S * len(data) + _LATENCY_S)
        now_s = self._wire.catch_up()
        reply = self._answer(bytes(data), now_s)
        TIME.advance(_BYTE_S * len(reply))
        self._waiting += reply
        return len(data)

    def read(self, count: int = 1) -> bytes:
        if len(self._waiting) < count:
            TIME.advance(self.timeout)
        taken = bytes(self._waiting[:count])
        del self._waiting[:count]
        return taken

    def read_until(self, end: bytes, size: int) -> bytes:
        place = self._waiting.find(end)
        return self.read(min(size, place + len(end)) if place >= 0 else size)

    def reset_input_buffer(self) -> None:
        self._waiting.clear()

    def close(self) -> None:
        self._waiting.clear()


def rtu_answer(device: OwnDrive, unit: int = 1) -> Any:
    """What a Modbus RTU drive answers: functions 3, 4, 6, 16, 23 (Modbus application protocol 1.1b3)."""

    def answer(data: bytes, _now_s: float) -> bytes:
        if len(data) < 4 or data[0] != unit or _crc(data[:-2]) != data[-2:]:
            return b""
        function, body = data[1], data[2:-2]
        try:
            reply = _carry_out(device, function, body)
        except Refused as refused:
            function, reply = function | 0x80, bytes([refused.code])
        head = bytes([unit, function]) + reply
        return head + _crc(head)

    return answer


def _carry_out(device: OwnDrive, function: int, body: bytes) -> bytes:
    words = [int.from_bytes(body[place : place + 2]) for place in range(0, 8, 2) if place < len(body)]
    if function in (3, 4):
        return _told(device.read(function, words[0], words[1]))
    if function == 6:
        device.write(function, words[0], [words[1]])
        return body
    if function == 16:
        device.write(function, words[0], _words(body[5:]))
        return body[:4]
    device.write(function, words[2], _words(body[9:]))
    return _told(device.read(function, words[0], words[1]))


def _words(data: bytes) -> list[int]:
    return [int.from_bytes(data[place : place + 2]) for place in range(0, len(data), 2)]


def _told(words: list[int]) -> bytes:
    return bytes([2 * len(words)]) + b"".join(word.to_bytes(2) for word in words)


def _crc(data: bytes) -> bytes:
    return FramerRTU.compute_CRC(data).to_bytes(2)


class CanWire:
    """A CAN bus as python-can offers it."""

    def __init__(self, wire: VirtualWire) -> None:
        self._wire = wire
        self._waiting: deque[Frame] = deque()
        wire.device.node.send = self._waiting.append
        wire.device.node.boot()

    def send(self, message: can.Message, _timeout_s: float | None = None) -> None:
        TIME.advance(_FRAME_S)
        now_s = self._wire.catch_up()
        frame = Frame(message.arbitration_id, bytes(message.data), message.is_remote_frame, message.is_extended_id)
        self._wire.device.receive(frame, now_s)

    def recv(self, timeout_s: float | None = None) -> can.Message | None:
        left_s = timeout_s or 0.0
        while True:
            self._wire.catch_up()
            if self._waiting:
                TIME.advance(_FRAME_S)
                frame = self._waiting.popleft()
                return can.Message(
                    arbitration_id=frame.can_id, data=frame.data, is_remote_frame=frame.remote,
                    is_extended_id=frame.extended, is_rx=True, timestamp=TIME.now(),
                )  # fmt: skip
            if left_s <= 0.0:
                return None
            TIME.advance(min(_WAIT_S, left_s))
            left_s -= _WAIT_S

    def shutdown(self) -> None:
        self._waiting.clear()


@contextmanager
def plugged_in(port: Any) -> Iterator[None]:
    """While entered, drivers that open a serial port or a bus get this one."""
    with ExitStack() as patches:
        patches.enter_context(mock.patch("drivers.host_time.processor_wait_s", return_value=0.0))  # of real time
        # virtual time waits for the store, as that of a drive in process does
        patches.enter_context(mock.patch("bench.control.clock.WallClock.patience_s", 30.0))
        patches.enter_context(mock.patch("drivers.canopen.cia301.link.open_bus", return_value=port))
        for name in ("Serial", "serial_for_url"):
            patches.enter_context(mock.patch(f"serial.{name}", return_value=port))
        yield
