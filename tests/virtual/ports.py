"""Ports of simulated devices in virtual time: in the place of pseudo-terminals and their threads, in one process.

Bytes, adapters, pace and faults are those of the real ports (`sim_backend.devices.link` and `can`); what is not there
is the operating system. A host opens them with pyserial, or python-can's adapter on it, by their path.
"""

import heapq
import itertools
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import serial

from sim_backend.devices.can.slcan import SlcanAdapter
from sim_backend.devices.link.faults import Direction, LinkFaultKind
from sim_backend.devices.link.line import Line
from sim_backend.devices.modbus.register_file import Unanswered
from sim_backend.devices.process import Workplace
from sim_backend.devices.wall_time import WallTime
from tests.commission.wires import rtu_answer

_LATENCY_S = 2e-4  # of a write: through the adapter and back
_LOOK_S = 1e-3  # a tick of a device, which may speak by itself
_GONE = "[Errno 5] Input/output error"
_NUMBERS = itertools.count(10_000)  # of files: none of the operating system's


class VirtualPort:
    """A device's port: bytes in both directions arrive when the line lets them.

    Args:
        device: what answers.
        clock: of the device.
        line: pace and faults.
        link: name of the port, which it keeps when it comes back.
    """

    error = None

    def __init__(self, device: Any, clock: WallTime, line: Line, link: Path | None = None) -> None:
        self.device, self._clock, self._line = device, clock, line
        self.path = str(link or f"virtual-{next(_NUMBERS)}")
        self.plugged = 0  # how often; odd while it is there
        self._order = itertools.count()
        self._under_way: list[tuple[float, int, Direction, bytes]] = []
        self.waiting = bytearray()

    def start(self) -> None:
        """Hosts can open it."""
        PORTS[self.path] = self
        self._plug()

    def close(self) -> None:
        """Hosts cannot any more."""
        PORTS.pop(self.path, None)
        self._unplug()

    def look(self) -> None:
        """Bring line and device to the present."""
        now_s = self._clock.now_s()
        is_out = self._line.faults.holds(LinkFaultKind.DISCONNECT, now_s)
        if is_out and self.plugged % 2:
            self._unplug()
        elif not is_out and not self.plugged % 2 and self.path in PORTS:
            self._plug()
        with self.device.lock:
            while self._under_way and self._under_way[0][0] <= now_s:
                at_s, _, direction, data = heapq.heappop(self._under_way)
                if direction is Direction.TO_DEVICE:
                    self._arrive(data, at_s)
                else:
                    self.waiting += data
            self.device.advance_to(now_s)
            self._move_on(now_s)

    def take(self, data: bytes) -> None:
        """What the host writes."""
        time.sleep(_LATENCY_S)
        self.look()
        self._clock.hear()
        self._carry(Direction.TO_DEVICE, data, self._clock.now_s())
        self.look()

    def pause(self, end_s: float) -> bool:
        """Wait until something may have come, or until a time [s] of `time.monotonic`; whether there was any left."""
        left_s = end_s - time.monotonic()
        if left_s <= 0.0:
            return False
        time.sleep(min(left_s, _LOOK_S))
        self.look()
        return True

    def _plug(self) -> None:
        self.plugged += 1
        self.device.connect()

    def _unplug(self) -> None:
        self.plugged += self.plugged % 2
        self._under_way.clear()
        self.waiting.clear()

    def _arrive(self, data: bytes, at_s: float) -> None:
        self.device.advance_to(at_s)
        self._carry(Direction.FROM_DEVICE, self.device.receive(data, max(at_s, self.device.axis.time_s)), at_s)

    def _carry(self, direction: Direction, data: bytes, now_s: float) -> None:
        for delivery in self._line.carry(direction, data, now_s) if data else ():
            heapq.heappush(self._under_way, (delivery.at_s, next(self._order), direction, delivery.data))

    def _move_on(self, now_s: float) -> None:
        """What the device has said meanwhile is there, too."""
        while self._under_way and self._under_way[0][0] <= now_s and self._under_way[0][2] is Direction.FROM_DEVICE:
            self.waiting += heapq.heappop(self._under_way)[3]


class VirtualSlcanPort(VirtualPort):
    """The same with an slcan adapter, and the device on its bus."""

    def start(self) -> None:
        """Hosts can open it; the device boots."""
        self.device.node.send = self._tell
        super().start()
        self.device.node.boot()

    def _plug(self) -> None:
        self.plugged += 1
        self._adapter = SlcanAdapter()

    def _arrive(self, data: bytes, at_s: float) -> None:
        answer, frames = self._adapter.feed(data)
        self._carry(Direction.FROM_DEVICE, answer, at_s)
        self.device.advance_to(at_s)
        for frame in frames:
            self.device.receive(frame, max(at_s, self.device.axis.time_s))

    def _tell(self, frame: Any) -> None:
        if self.plugged % 2:
            self._carry(Direction.FROM_DEVICE, self._adapter.tell(frame), self.device.axis.time_s)


class _RtuDevice:
    """A device with registers as one on a serial line."""

    def __init__(self, device: Any, unit: int) -> None:
        self._device, self._answer = device, rtu_answer(device, unit)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._device, name)

    def connect(self) -> None:
        """Half a packet is forgotten with the port."""

    def receive(self, data: bytes, time_s: float) -> bytes:
        """What is answered; nothing where nothing must be."""
        try:
            answer: bytes = self._answer(data, time_s)
        except Unanswered:
            return b""
        return answer


def rtu_port(device: Any, settings: Any, place: Workplace) -> VirtualPort:
    """The port of a device with registers."""
    assert settings.transport == "rtu", "over TCP it is in the operating system's time"
    line = Line(settings.baud, place.faults, settings.seed)
    return VirtualPort(_RtuDevice(device, settings.unit), place.clock, line, settings.link)


PORTS: dict[str, VirtualPort] = {}
_OPEN: dict[int, "VirtualSerial"] = {}


class VirtualSerial:
    """What pyserial opens.

    Raises:
        SerialException: there is no such port.
    """

    is_open = True

    def __init__(self, port: str, _baud_rate: int = 0, timeout: float | None = None, **_more: Any) -> None:
        self.timeout, self.inter_byte_timeout, self.write_timeout = timeout, 0.0, None
        found = PORTS.get(port)
        if found is not None:
            found.look()
        if found is None or not found.plugged % 2:
            raise serial.SerialException(2, f"could not open port {port}: No such file or directory: '{port}'")
        self._port, self._plugged, self._number = found, found.plugged, next(_NUMBERS)
        _OPEN[self._number] = self

    @property
    def in_waiting(self) -> int:
        """Bytes that have come."""
        self._look()
        return len(self._port.waiting)

    @property
    def is_gone(self) -> bool:
        """Whether the port was unplugged since it was opened."""
        self._port.look()
        return self._port.plugged != self._plugged

    def fileno(self) -> int:
        """For `os.write` and `select` of who writes past pyserial."""
        return self._number

    def write(self, data: bytes) -> int:
        """Send."""
        self._look()
        self._port.take(bytes(data))
        return len(data)

    def flush(self) -> None:
        """Everything is sent."""

    def read(self, count: int = 1) -> bytes:
        """So many bytes, or what has come in time."""
        end_s = time.monotonic() + (1e9 if self.timeout is None else self.timeout)
        self._look()
        while len(self._port.waiting) < count and self._port.pause(end_s):
            self._look()
        taken = bytes(self._port.waiting[:count])
        del self._port.waiting[:count]
        return taken

    def read_until(self, end: bytes, size: int) -> bytes:
        """Bytes up to an end."""
        found = b""
        while len(found) < size and not found.endswith(end) and (more := self.read(1)):
            found += more
        return found

    def reset_input_buffer(self) -> None:
        """Forget what has come."""
        self._look()
        self._port.waiting.clear()

    def close(self) -> None:
        """Give it back."""
        self.is_open = False
        _OPEN.pop(self._number, None)

    def wait(self, end_s: float) -> bool:
        """Whether there is something to read, an end of the port too, before a time [s] of `time.monotonic`."""
        while not self.is_gone and not self._port.waiting:
            if not self._port.pause(end_s):
                return False
        return True

    def _look(self) -> None:
        if self.is_gone:
            raise serial.SerialException(5, f"read failed: {_GONE}")
        if not self.is_open:
            raise serial.PortNotOpenError()


def _select(readers: list[int], writers: list[int], _others: list[int], timeout_s: float) -> Any:
    """`select.select` of one of these ports."""
    ready = [one for one in readers if _OPEN[one].wait(time.monotonic() + timeout_s)]
    return ready, writers, []


def _write(number: int, data: bytes) -> int:
    """`os.write`."""
    if _OPEN[number].is_gone:
        raise OSError(5, "Input/output error")
    return _OPEN[number].write(data)


OS, SELECT = SimpleNamespace(write=_write), SimpleNamespace(select=_select)
