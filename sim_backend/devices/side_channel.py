"""The way past the drive's own protocol to a simulated device: one JSON object a line, over TCP on this machine.

{"do": "hang", "load_kg": 0.05, "balanced": true}   ->  {"ok": true}
{"do": "truth"}                                     ->  {"ok": true, "powered": false, ...}
{"do": "fault", "name": "over-current"}             ->  {"ok": false, "error": "..."}
"""

import contextlib
import json
import math
import socketserver
import threading
from typing import Any

from sim_backend.devices.hand import Answer, Hand
from sim_backend.errors import SimulationError


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
