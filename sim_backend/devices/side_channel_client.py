"""The client of a simulated device's side channel, see `process.py`: knows neither device nor plant."""

import json
import socket
from typing import Any

from sim_backend.errors import ParameterError

_ANSWER_S = 5.0  # longest wait for an answer


class SideChannelClient:
    """A conversation with a simulated device, over its side channel."""

    def __init__(self, address: str) -> None:
        host, _, port = address.rpartition(":")
        self._socket = socket.create_connection((host, int(port)), _ANSWER_S)
        self._file = self._socket.makefile("rw", encoding="utf-8")

    def ask(self, deed: str, **values: Any) -> dict[str, Any]:
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
        answer: dict[str, Any] = json.loads(line)
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


def ask_once(address: str, deed: str, **values: Any) -> dict[str, Any]:
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
