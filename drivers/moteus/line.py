"""A serial line to controllers: frames out, frames in, in bounded time; several controllers in one go."""

import time
from collections.abc import Mapping

from drivers.host_time import ATTEMPTS, no_answer
from drivers.moteus.text import LONGEST_LINE, received, send_line
from drivers.serial_port import SerialPort

_BAUD_RATE = 921_600  # of the UART; an adapter on USB does not mind
_RESYNC_S = 0.005
_MOST_BYTES = 1 << 16  # a line that babbles must not hold the loop

HOST = 0  # id of this host


class MoteusLine:
    """An open port.

    Args:
        port: "/dev/serial/by-id/...fdcanusb...".
        over_uart: whether lines have checksums.
        timeout_s: longest wait for the answers of one exchange [s].

    Raises:
        DriveConnectionError: the port is not there, or somebody else uses it.
    """

    def __init__(self, port: str, over_uart: bool, timeout_s: float) -> None:
        self._name, self._over_uart, self._timeout_s = port, over_uart, timeout_s
        self._port = SerialPort(port, port, _BAUD_RATE, timeout_s)
        self._heard = b""

    def close(self) -> None:
        """Give the port back. Safe to call twice."""
        self._port.close()

    def ask(self, questions: Mapping[int, bytes], what: str) -> dict[int, bytes]:
        """Send a frame to each of some controllers, and take the answer of each.

        Raises:
            DriveConnectionError: one of them does not answer, or the port is gone.
        """
        began_s = time.perf_counter()
        request = b"".join(self._line(servo_id, data, True) for servo_id, data in questions.items())
        missing = set(questions)
        for _ in range(ATTEMPTS):
            self._port.shout(request)
            answers = self._answers(missing)
            if len(answers) == len(questions):
                return answers
            self._heard = b""
            self._port.rest(_RESYNC_S)
        silent = ", ".join(str(servo_id) for servo_id in sorted(missing - set(answers)))
        check = "servo_id, over_uart and the bit rates (1 and 5 Mbit/s)"
        raise no_answer(
            f"{self._name} servo {silent}", f"{what}: found no answer", check, self._timeout_s, began_s, _RESYNC_S
        )

    def tell(self, servo_id: int, data: bytes) -> None:
        """Send a frame that is not answered. Never raises."""
        self._port.shout(self._line(servo_id, data, False))

    def listen(self, questions: Mapping[int, bytes], wait_s: float) -> list[tuple[int, bytes]]:
        """Ask some controllers, of which any may not be there, or twice; every answer that comes within a time [s].

        Raises:
            DriveConnectionError: the port is gone.
        """
        self._taken(self._port.arrived())  # what comes late is no answer to this question
        found: list[tuple[int, bytes]] = []
        for servo_id, data in questions.items():
            self._port.shout(self._line(servo_id, data, True))
            found += self._taken(self._port.arrived())
        end_s = time.perf_counter() + wait_s
        while time.perf_counter() < end_s:
            found += self._taken(self._port.read(1) + self._port.arrived())
        return found

    def _line(self, servo_id: int, data: bytes, wants_answer: bool) -> bytes:
        can_id = (0x8000 if wants_answer else 0) | HOST << 8 | servo_id
        return send_line(can_id, data, self._over_uart)

    def _answers(self, wanted: set[int]) -> dict[int, bytes]:
        """What has come of those that are wanted, when all have answered or the time is up."""
        found: dict[int, bytes] = {}
        end_s, taken = time.perf_counter() + self._timeout_s, 0
        while len(found) < len(wanted) and taken < _MOST_BYTES:
            more = self._port.read(1) + self._port.arrived()
            taken += len(more)
            found |= {one: data for one, data in self._taken(more) if one in wanted}
            if not more and time.perf_counter() >= end_s:
                break
        return found

    def _taken(self, data: bytes) -> list[tuple[int, bytes]]:
        """The frames to this host in bytes that have come; half a line waits for the rest."""
        found: list[tuple[int, bytes]] = []
        *lines, self._heard = (self._heard + data).replace(b"\r", b"\n").split(b"\n")
        for line in lines:
            frame = received(line, self._over_uart)
            if frame is not None and frame.can_id & 0xFF == HOST:
                found.append((frame.can_id >> 8 & 0x7F, frame.data))
        self._heard = self._heard[-LONGEST_LINE:]
        return found
