"""The way past the drive's own protocol to a simulated device: one JSON object a line, over TCP on this machine.

{"do": "hang", "load_kg": 0.05, "balanced": true}   ->  {"ok": true}
{"do": "truth"}                                     ->  {"ok": true, "powered": false, ...}
{"do": "fault", "name": "over-current"}             ->  {"ok": false, "error": "..."}
"""

import contextlib
import json
import math
import socket
import socketserver
import threading
from typing import Any

from sim_backend.devices.hand import Answer, Hand
from sim_backend.errors import ParameterError, SimulationError


class SideChannel(socketserver.ThreadingTCPServer):
    """Serves a hand on the loopback interface, from a thread.

    Args:
        hand: what does the deeds.
        port: TCP port; 0 is any free one, see `address`.
    """

    allow_reuse_address = True
    daemon_threads = True
    block_on_close = False

    def __init__(self, hand: Hand, port: int = 0) -> None:
        self.hand = hand
        super().__init__(("127.0.0.1", port), _Visitor)
        self._thread = threading.Thread(target=self.serve_forever, args=(0.05,), name="side channel", daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        """Where it listens, as host:port."""
        host, port = self.socket.getsockname()
        return f"{host}:{port}"

    def close(self) -> None:
        """End the thread and the port."""
        self.shutdown()
        self._thread.join()
        self.server_close()


class SideChannelClient:
    """The other end.

    Args:
        address: host:port.
        timeout_s: longest wait for an answer [s].
    """

    def __init__(self, address: str, timeout_s: float = 5.0) -> None:
        host, _, port = address.rpartition(":")
        self._socket = socket.create_connection((host, int(port)), timeout_s)
        self._file = self._socket.makefile("rw", encoding="utf-8")

    def ask(self, deed: str, **values: Any) -> Answer:
        """Have something done.

        Raises:
            ParameterError: the device says no, and why.
            OSError: it does not answer in time, or is gone.
        """
        self._file.write(json.dumps({"do": deed, **values}) + "\n")
        self._file.flush()
        line = self._file.readline()
        if not line:
            raise ConnectionError("the simulated device has closed its side channel; is its process still there?")
        answer: Answer = json.loads(line)
        if not answer.pop("ok"):
            raise ParameterError(answer["error"])
        return answer

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load on the arm."""
        self.ask("hang", load_kg=load_kg, balanced=balanced)

    def close(self) -> None:
        """Hang up."""
        self._file.close()
        self._socket.close()


def ask_once(address: str, deed: str, **values: Any) -> Answer:
    """Have one thing done.

    Raises:
        ParameterError: the device says no, and why.
        OSError: it is not there, or does not answer in time.
        ValueError: the address is no host:port.
    """
    client = SideChannelClient(address)
    try:
        return client.ask(deed, **values)
    finally:
        client.close()


class _Visitor(socketserver.StreamRequestHandler):
    server: SideChannel

    def handle(self) -> None:
        with contextlib.suppress(ConnectionError):  # a visitor who leaves in the middle is no error
            for line in self.rfile:
                self.wfile.write(json.dumps(_finite(self._answer(line))).encode() + b"\n")

    def _answer(self, line: bytes) -> Answer:
        try:
            request = json.loads(line)
            deed = request.pop("do")
        except (ValueError, KeyError, AttributeError, TypeError):
            return {"ok": False, "error": 'one JSON object a line is wanted, such as {"do": "truth"}'}
        try:
            return {"ok": True, **self.server.hand.do(deed, request)}
        except SimulationError as error:
            return {"ok": False, "error": str(error)}


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(one) for key, one in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value
