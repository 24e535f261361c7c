"""A way between two byte streams: bytes pass at the line's pace and with its faults."""

import contextlib
import select
import socket
import threading
from typing import Protocol

from sim_backend.devices.link.faults import Direction
from sim_backend.devices.link.line import Line, pause_until
from sim_backend.devices.link.port import LOOK_UP_S
from sim_backend.devices.wall_time import WallTime


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
                data = source.read(LOOK_UP_S)
                if data and direction is Direction.TO_DEVICE:
                    self._clock.hear()
                for delivery in self._line.carry(direction, data, self._clock.now_s()) if data else ():
                    pause_until(self._clock, delivery.at_s)
                    target.write(delivery.data)
            except (OSError, ValueError):  # gone, or closed from here
                self._over.set()
