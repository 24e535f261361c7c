"""The ports behind which an adapter sits: a pseudo-terminal (slcan) or a TCP server (socketcand)."""

import heapq
import itertools
import select
import socket
import threading
from abc import abstractmethod
from collections.abc import Callable
from pathlib import Path

from sim_backend.devices.can.frame import Adapter, CanDevice, Frame
from sim_backend.devices.can.slcan import SlcanAdapter
from sim_backend.devices.can.socketcand import SocketcandSession
from sim_backend.devices.link.faults import Direction
from sim_backend.devices.link.line import Line, pause_until
from sim_backend.devices.link.port import LOOK_UP_S, PortThread
from sim_backend.devices.link.pseudo_terminal import PseudoTerminal, Unwritten
from sim_backend.devices.wall_time import WallTime


class Stream:
    """The adapter's end.

    What the line holds back is sent later by a thread, so that the drive never waits for it.
    """

    def __init__(
        self, adapter: Adapter, line: Line, clock: WallTime, write: Callable[[bytes], None],
        deliver: Callable[[Frame], None],
    ) -> None:  # fmt: skip
        self._adapter = adapter
        self._line = line
        self._clock = clock
        self._write = write
        self._deliver = deliver
        self._order = itertools.count()
        self._held: list[tuple[float, int, bytes]] = []
        self._news = threading.Condition()
        self._closed = False
        self._sender = threading.Thread(target=self._send_held, name="device stream", daemon=True)
        self._sender.start()
        self._put(adapter.greet())

    def arrive(self, data: bytes) -> None:
        """Take bytes of the host."""
        self._clock.hear()
        for delivery in self._line.carry(Direction.TO_DEVICE, data, self._clock.now_s()):
            pause_until(self._clock, delivery.at_s)
            answer, frames = self._adapter.feed(delivery.data)
            self._put(answer)
            for frame in frames:
                self._deliver(frame)

    def tell(self, frame: Frame) -> None:
        """Tell the host of a frame on the bus."""
        self._put(self._adapter.tell(frame))

    def close(self) -> None:
        """End the thread; what is held back is lost."""
        with self._news:
            self._closed = True
            self._news.notify()
        self._sender.join()

    def _put(self, data: bytes) -> None:
        if not data:
            return
        now_s = self._clock.now_s()
        with self._news:
            for delivery in self._line.carry(Direction.FROM_DEVICE, data, now_s):
                if delivery.at_s <= now_s and not self._held:
                    self._write(delivery.data)
                else:
                    heapq.heappush(self._held, (delivery.at_s, next(self._order), delivery.data))
                    self._news.notify()

    def _send_held(self) -> None:
        with self._news:
            while not self._closed:
                left_s = self._held[0][0] - self._clock.now_s() if self._held else None
                if left_s is None or left_s > 0.0:
                    self._news.wait(left_s)
                else:
                    self._write(heapq.heappop(self._held)[2])


class CanDevicePort(PortThread):
    """The device's bus, and the thread that reads."""

    def __init__(self, device: CanDevice, clock: WallTime, line: Line, name: str) -> None:
        super().__init__(line, clock, name)
        self._device = device
        device.node.send = self._tell

    def _begin(self) -> None:
        with self._device.lock:
            self._device.node.boot()

    def _deliver(self, frame: Frame) -> None:
        with self._device.lock:
            now_s = self._clock.now_s()
            self._device.advance_to(now_s)
            self._device.receive(frame, now_s)

    @abstractmethod
    def _tell(self, frame: Frame) -> None:
        """Tell hosts of a frame of the device's."""


class SlcanPort(CanDevicePort):
    """An slcan adapter on a pseudo-terminal."""

    def __init__(self, device: CanDevice, clock: WallTime, line: Line, link: Path | None = None) -> None:
        self._link = link
        self._terminal: PseudoTerminal | None = None
        self._stream: Stream | None = None
        super().__init__(device, clock, line, "slcan adapter")
        self.path = self._plug().path

    def _serve(self) -> None:
        terminal = self._terminal or self._plug()
        data = terminal.read(LOOK_UP_S)
        if data and self._stream is not None:
            self._stream.arrive(data)

    def _plug(self) -> PseudoTerminal:
        terminal = PseudoTerminal(self._link)
        self._stream = Stream(SlcanAdapter(), self._line, self._clock, terminal.write, self._deliver)
        self._terminal, self.path = terminal, terminal.path
        return terminal

    def _unplug(self) -> None:
        stream, self._stream = self._stream, None
        if stream is not None:
            stream.close()
        if self._terminal is not None:
            self._terminal.close()
            self._terminal = None

    def _tell(self, frame: Frame) -> None:
        if self._stream is not None:
            self._stream.tell(frame)


class SocketcandPort(CanDevicePort):
    """A socketcand server on the loopback interface. Hosts see the device and each other, as on one bus.

    Args:
        device: what is on the bus.
        clock: of the device.
        line: pace and faults, of every connection.
        port: TCP port; 0 is any free one.
    """

    def __init__(self, device: CanDevice, clock: WallTime, line: Line, port: int = 0) -> None:
        self._streams: dict[socket.socket, Stream] = {}
        self._server = socket.create_server(("127.0.0.1", port))
        host, number = self._server.getsockname()
        self.path = f"{host}:{number}"
        super().__init__(device, clock, line, "socketcand server")

    def close(self) -> None:
        """End the thread, the connections and the server."""
        super().close()
        self._server.close()

    def _serve(self) -> None:
        ready, _, _ = select.select([self._server, *self._streams], [], [], LOOK_UP_S)
        for one in ready:
            if one is self._server:
                self._welcome()
            elif one in self._streams:
                self._read(one)

    def _welcome(self) -> None:
        connection, _ = self._server.accept()
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

        unwritten = Unwritten(lambda data: connection.send(data, socket.MSG_DONTWAIT))

        def deliver(frame: Frame) -> None:
            for other, stream in list(self._streams.items()):
                if other is not connection:
                    stream.tell(frame)
            self._deliver(frame)

        self._streams[connection] = Stream(SocketcandSession(), self._line, self._clock, unwritten.put, deliver)

    def _read(self, connection: socket.socket) -> None:
        try:
            data = connection.recv(4096)
        except ConnectionError:
            data = b""
        if data:
            self._streams[connection].arrive(data)
        else:
            self._drop(connection)

    def _drop(self, connection: socket.socket) -> None:
        self._streams.pop(connection).close()
        connection.close()

    def _unplug(self) -> None:
        for connection in list(self._streams):
            self._drop(connection)

    def _tell(self, frame: Frame) -> None:
        for stream in list(self._streams.values()):
            stream.tell(frame)
