"""A TCP port for hosts, in front of a server of somebody else's."""

import contextlib
import socket

from sim_backend.devices.link.line import Line
from sim_backend.devices.link.passage import Passage, SocketEnd
from sim_backend.devices.link.port import LOOK_UP_S, PortThread
from sim_backend.devices.wall_time import WallTime

_CONNECTING_S = 5.0


class TcpRelay(PortThread):
    """A port on the loopback interface.

    Args:
        line: pace and faults, of every connection.
        clock: of the device.
        server: address of the server.
        port: for hosts; 0 is any free one.
    """

    def __init__(self, line: Line, clock: WallTime, server: tuple[str, int], port: int = 0) -> None:
        super().__init__(line, clock, "TCP relay")
        self._server = server
        self._passages: list[Passage] = []
        self._listener = socket.create_server(("127.0.0.1", port))
        self._listener.settimeout(LOOK_UP_S)
        self.path = f"127.0.0.1:{self._listener.getsockname()[1]}"

    def close(self) -> None:
        """End the thread, every connection and the port."""
        super().close()
        self._listener.close()

    def _serve(self) -> None:
        for passage in [one for one in self._passages if one.is_over]:
            passage.close()
            self._passages.remove(passage)
        with contextlib.suppress(TimeoutError):
            connection, _ = self._listener.accept()
            inner = socket.create_connection(self._server, _CONNECTING_S)
            self._passages.append(Passage(SocketEnd(connection), SocketEnd(inner), self._line, self._clock))

    def _pass_time(self) -> None:
        """Turn hosts away."""
        with contextlib.suppress(TimeoutError):
            connection, _ = self._listener.accept()
            connection.close()

    def _unplug(self) -> None:
        for passage in self._passages:
            passage.close()
        self._passages.clear()
