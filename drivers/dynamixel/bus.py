"""The serial bus: packets in bounded time, one servo or several in one exchange."""

import time

from drivers.dynamixel.control_table import Item, refusal
from drivers.dynamixel.frames import (
    STATUS_BYTES,
    StatusPacket,
    packet,
    packet_bytes,
    read_packet,
    status,
    sync_read_packet,
    sync_write_packet,
    write_packet,
)
from drivers.errors import DriveConnectionError, DriveStateError
from drivers.host_time import host_was_away
from drivers.serial_port import SerialPort

ATTEMPTS = 2
_MEASURED = "what it measures"
RESYNC_S = 0.005  # no servo is in the middle of an answer by then


class Bus:
    """An open serial line with servos on it.

    Args:
        port: "/dev/ttyUSB0".
        baud_rate: of the line.
        timeout_s: longest wait for one answer [s].

    Raises:
        DriveConnectionError: the port is not there, or somebody else uses it.
    """

    def __init__(self, port: str, baud_rate: int, timeout_s: float) -> None:
        self._name, self._baud_rate, self._timeout_s = port, baud_rate, timeout_s
        self._deadline_s = 0.0
        self._port = SerialPort(port, port, baud_rate, timeout_s)
        self._requests: dict[tuple[tuple[int, ...], int, int], bytes] = {}

    @staticmethod
    def longest_call_s(timeout_s: float) -> float:
        """By then whoever has called `begin` has his answers, or an error [s]."""
        return 2 * (ATTEMPTS + 1) * (timeout_s + RESYNC_S)  # an answer may come in two pieces

    def begin(self) -> None:
        """A call of the contract begins: from now on its questions share one time limit."""
        self._deadline_s = time.perf_counter() + ATTEMPTS * (self._timeout_s + RESYNC_S)

    def close(self) -> None:
        """Give the port back. Safe to call twice."""
        self._port.close()

    def read(self, servo_id: int, item: Item) -> int:
        """The value of an item, unsigned.

        Raises:
            DriveConnectionError: no intact answer in time, or the port is gone.
            DriveStateError: the servo refuses.
        """
        found = self._ask(read_packet(servo_id, item.address, item.size), (servo_id,), item.size, item.name)[0]
        return int.from_bytes(self._taken(found, item.name).data, "little")

    def write(self, servo_id: int, item: Item, value: int) -> None:
        """Write an item, and wait until the servo says that it has taken it.

        Raises:
            DriveConnectionError, DriveStateError: as `read`.
        """
        data = (value & (1 << 8 * item.size) - 1).to_bytes(item.size, "little")
        found = self._ask(write_packet(servo_id, item.address, data), (servo_id,), 0, item.name)[0]
        self._taken(found, f"{item.name} = {value}")

    def instruct(self, servo_id: int, instruction: int, what: str) -> StatusPacket:
        """Send an instruction without parameters; a ping is answered with three bytes.

        Raises:
            DriveConnectionError: no intact answer in time, or the port is gone.
        """
        return self._ask(packet(servo_id, instruction), (servo_id,), 0, what)[0]

    def exchange(
        self, goals: dict[int, dict[int, bytes]], servo_ids: tuple[int, ...], address: int, size: int
    ) -> list[StatusPacket]:
        """Write the goals of some servos, and read the same piece of the control table of each, in one go.

        Args:
            goals: bytes by servo, by the address where they go; empty: nothing is written.
            servo_ids: whom to ask, in this order.
            address: of the piece.
            size: of the piece, in bytes.

        Raises:
            DriveConnectionError: no intact answer of each in time, or the port is gone.
            DriveStateError: a servo refuses.
        """
        request = self._requests.get((servo_ids, address, size))
        if request is None:
            asking = read_packet(servo_ids[0], address, size)
            request = asking if len(servo_ids) == 1 else sync_read_packet(servo_ids, address, size)
            self._requests[servo_ids, address, size] = request
        if goals:
            request = b"".join(sync_write_packet(one, where) for where, one in goals.items()) + request
        return [self._taken(found, _MEASURED) for found in self._ask(request, servo_ids, size, _MEASURED)]

    def shout(self, servo_id: int, item: Item, value: int) -> None:
        """Write an item of one byte, and wait for no answer. Never raises."""
        self._port.shout(write_packet(servo_id, item.address, bytes((value,))))

    def listen(self, request: bytes, wait_s: float) -> list[StatusPacket]:
        """Send a packet that nobody or many answer, and take what comes until nothing has for a time [s].

        Raises:
            DriveConnectionError: the port is gone.
        """
        heard = self._port.ask(request, 0)
        end_s = time.perf_counter() + wait_s
        while time.perf_counter() < end_s:
            more = self._port.read(1)
            heard += more + self._port.read(0)
            if more:
                end_s = time.perf_counter() + wait_s
        return _packets(heard)

    def _ask(self, request: bytes, servo_ids: tuple[int, ...], size: int, what: str) -> list[StatusPacket]:
        """Ask, asked again once where not everybody answered intact."""
        began_s, found = time.perf_counter(), "nothing"
        for _ in range(ATTEMPTS):
            reply = self._port.ask(request, (STATUS_BYTES + size) * len(servo_ids))
            answers, found = self._apart(reply, servo_ids, size)
            if len(answers) == len(servo_ids):
                return answers
            self._port.rest(RESYNC_S)
            if time.perf_counter() >= self._deadline_s:
                break
        longest_s = ATTEMPTS * (self._timeout_s + RESYNC_S)
        away = host_was_away(time.perf_counter() - began_s, longest_s, self._timeout_s)
        raise DriveConnectionError(
            self._device(*servo_ids),
            f"{what}: found {found} within {self._timeout_s:g} s, asked {ATTEMPTS} times at most; check the cable, the "
            f"power, the id and the baud rate ({self._baud_rate}){away}",
        )

    def _apart(self, reply: bytes, servo_ids: tuple[int, ...], size: int) -> tuple[list[StatusPacket], str]:
        """The answers of some servos in a row, and what was found where one of them is missing."""
        answers: list[StatusPacket] = []
        start = 0
        for place, servo_id in enumerate(servo_ids):
            length = packet_bytes(reply[start : start + STATUS_BYTES])
            if not length:
                return answers, _seen(reply, start)
            left = length + (STATUS_BYTES + size) * (len(servo_ids) - place - 1) - (len(reply) - start)
            if left > 0:  # an answer is longer where it was stuffed
                reply += self._port.read(left)
            answer = status(reply[start : start + length])
            if answer is None:
                return answers, "an answer with a wrong CRC: noise, or two servos of one id"
            if answer.servo_id != servo_id or (len(answer.data) < size and not answer.error):
                return answers, f"an answer of id {answer.servo_id}, {len(answer.data)} bytes"
            answers.append(answer)
            start += length
        return answers, ""

    def _device(self, *servo_ids: int) -> str:
        """The name used in messages."""
        return f"{self._name} id {', '.join(str(servo_id) for servo_id in servo_ids)}"

    def _taken(self, found: StatusPacket, what: str) -> StatusPacket:
        why = refusal(found.error)
        if why:
            raise DriveStateError(self._device(found.servo_id), f"{what}: refused, {why}; see the servo's e-Manual")
        return found


def _seen(reply: bytes, start: int) -> str:
    if len(reply) <= start:
        return "nothing"
    return f"{len(reply) - start} bytes that are no answer: noise, another baud rate, or two servos of one id"


def _packets(heard: bytes) -> list[StatusPacket]:
    """Every intact packet in what was heard."""
    found, start = [], 0
    while (length := packet_bytes(heard[start:])) or start < len(heard):
        answer = status(heard[start : start + length]) if length else None
        if answer is not None:
            found.append(answer)
        start += length if answer is not None else 1
    return found
