"""A line between a host and a server of somebody else's: bytes pass at the line's pace and with its faults."""

import contextlib
import select
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from sim_backend.devices.link.faults import Direction, LinkFaultKind
from sim_backend.devices.link.line import Line
from sim_backend.devices.link.pause import pause_until
from sim_backend.devices.link.pseudo_terminal import PseudoTerminal
from sim_backend.devices.wall_time import WallTime

_LOOK_UP_S = 0.02  # how soon a thread notices that it shall end


class End(Protocol):
    """One end of a byte stream."""

    def read(self, timeout_s: float) -> bytes:
        """Return what has come; b'' where nothing has in time. Raises `OSError` when the stream is over."""

    def write(self, data: bytes) -> None:
        """Write without waiting."""

    def close(self) -> None:
        """Close."""


class SocketEnd:
    """A TCP connection as an end."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def read(self, timeout_s: float) -> bytes:
        """Return what has come."""
        ready, _, _ = select.select([self._connection], [], [], timeout_s)
        if not ready:
            return b""
        data = self._connection.recv(4096)
        if not data:
            raise ConnectionError("closed by the other side")
        return data

    def write(self, data: bytes) -> None:
        """Write without waiting."""
        with contextlib.suppress(BlockingIOError):
            self._connection.send(data, socket.MSG_DONTWAIT)

    def close(self) -> None:
        """Close."""
        self._connection.close()


class Passage:
    """Two threads, one each way, between two ends."""

    def __init__(self, host: End, server: End, line: Line, clock: WallTime) -> None:
        self._ends = (host, server)
        self._line = line
        self._clock = clock
        self._over = threading.Event()
        ways = ((host, server, Direction.TO_DEVICE), (server, host, Direction.FROM_DEVICE))
        self._threads = [threading.Thread(target=self._carry, args=way, daemon=True) for way in ways]
        for thread in self._threads:
            thread.start()

    @property
    def is_over(self) -> bool:
        """Whether either side has gone."""
        return self._over.is_set()

    def close(self) -> None:
        """End both threads and close both ends."""
        self._over.set()
        for thread in self._threads:
            thread.join()
        for end in self._ends:
            end.close()

    def _carry(self, source: End, target: End, direction: Direction) -> None:
        while not self._over.is_set():
            try:
                data = source.read(_LOOK_UP_S)
                for delivery in self._line.carry(direction, data, self._clock.now_s()) if data else ():
                    pause_until(self._clock, delivery.at_s)
                    target.write(delivery.data)
            except (OSError, ValueError):  # gone, or closed from here
                self._over.set()


class SerialRelay(threading.Thread):
    """A serial port for hosts, in front of a server that has opened `inner`.

    Args:
        line: pace and faults.
        clock: of the device.
        link: symbolic link for the host's end.
    """

    def __init__(self, line: Line, clock: WallTime, link: Path | None = None) -> None:
        super().__init__(name="serial relay", daemon=True)
        self._line = line
        self._clock = clock
        self._link = link
        self._server = _Kept(PseudoTerminal())
        self._closing = threading.Event()
        self._outer = PseudoTerminal(link)
        self._passage = Passage(self._outer, self._server, line, clock)
        self.inner = self._server.path
        self.path = self._outer.path
        self.error: BaseException | None = None

    def run(self) -> None:
        """Take the port away while the line is disconnected, and bring it back."""
        while not self._closing.wait(_LOOK_UP_S):
            if self._line.faults.holds(LinkFaultKind.DISCONNECT, self._clock.now_s()):
                self._passage.close()
                while self._line.faults.holds(LinkFaultKind.DISCONNECT, self._clock.now_s()):
                    if self._closing.wait(_LOOK_UP_S):
                        return
                self._outer = PseudoTerminal(self._link)
                self.path = self._outer.path
                self._passage = Passage(self._outer, self._server, self._line, self._clock)

    def close(self) -> None:
        """End the thread and the ports."""
        self._closing.set()
        if self.is_alive():
            self.join()
        self._passage.close()
        self._server.end()


class _Kept:
    """A pseudo-terminal that outlives the passages through it."""

    def __init__(self, terminal: PseudoTerminal) -> None:
        self._terminal = terminal
        self.path = terminal.path
        self.read: Callable[[float], bytes] = terminal.read
        self.write: Callable[[bytes], None] = terminal.write
        self.end = terminal.close

    def close(self) -> None:
        """Stay."""


class TcpRelay(threading.Thread):
    """A TCP port for hosts, in front of a server.

    Args:
        line: pace and faults, of every connection.
        clock: of the device.
        server: address of the server.
        port: for hosts; 0 is any free one.
    """

    def __init__(self, line: Line, clock: WallTime, server: tuple[str, int], port: int = 0) -> None:
        super().__init__(name="TCP relay", daemon=True)
        self._line = line
        self._clock = clock
        self._server = server
        self._closing = threading.Event()
        self._passages: list[Passage] = []
        self._listener = socket.create_server(("127.0.0.1", port))
        self._listener.settimeout(_LOOK_UP_S)
        self._port = self._listener.getsockname()[1]
        self.path = f"127.0.0.1:{self._port}"
        self.error: BaseException | None = None

    def run(self) -> None:
        """Take connections until `close`; none while the line is disconnected."""
        try:
            while not self._closing.is_set():
                self._serve()
        except BaseException as error:
            self.error = error
            raise
        finally:
            self._drop_all()

    def close(self) -> None:
        """End the thread and every connection."""
        self._closing.set()
        if self.is_alive():
            self.join()
        self._drop_all()
        self._listener.close()

    def _serve(self) -> None:
        for passage in [one for one in self._passages if one.is_over]:
            passage.close()
            self._passages.remove(passage)
        with contextlib.suppress(TimeoutError):
            connection, _ = self._listener.accept()
            if self._line.faults.holds(LinkFaultKind.DISCONNECT, self._clock.now_s()):
                connection.close()
            else:
                inner = socket.create_connection(self._server, 5.0)
                self._passages.append(Passage(SocketEnd(connection), SocketEnd(inner), self._line, self._clock))
        if self._line.faults.holds(LinkFaultKind.DISCONNECT, self._clock.now_s()):
            self._drop_all()

    def _drop_all(self) -> None:
        for passage in self._passages:
            passage.close()
        self._passages.clear()
