"""The serial bus: packets in bounded time, one servo or several in one exchange."""

import time
from collections.abc import Iterator

from drivers.errors import DriveStateError
from drivers.host_time import ATTEMPTS, no_answer
from drivers.serial_port import SerialPort
from drivers.servos.frames import Frames, Item, StatusPacket

_ALONE_S = 0.006  # longest wait for the answer to a ping of one servo
_ALL_S = 0.1  # of a further one, where everybody was asked
RESYNC_S = 0.005  # no servo is in the middle of an answer by then


class ServoBus:
    """An open serial line with servos on it.

    Args:
        port: "/dev/ttyUSB0".
        baud_rate: of the line.
        timeout_s: longest wait for one answer [s].
        frames: of the protocol.

    Raises:
        DriveConnectionError: the port is not there, or somebody else uses it.
    """

    def __init__(self, port: str, baud_rate: int, timeout_s: float, frames: Frames) -> None:
        self._frames = frames
        self._name, self._baud_rate, self._timeout_s = port, baud_rate, timeout_s
        self._deadline_s = 0.0
        self._port = SerialPort(port, port, baud_rate, timeout_s)
        self._requests: dict[tuple[tuple[int, ...], int], bytes] = {}

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
        found = self._ask(self._frames.read(servo_id, item.address, item.size), (servo_id,), item.size, item.name)[0]
        return int.from_bytes(self._taken(found, item.name).data, "little")

    def write(self, servo_id: int, item: Item, value: int) -> None:
        """Write an item, and wait until the servo says that it has taken it.

        Raises:
            DriveConnectionError, DriveStateError: as `read`.
        """
        data = (value & (1 << 8 * item.size) - 1).to_bytes(item.size, "little")
        found = self._ask(self._frames.write(servo_id, item.address, data), (servo_id,), 0, item.name)[0]
        self._taken(found, f"{item.name} = {value}")

    def instruct(self, servo_id: int, packet: bytes, what: str) -> None:
        """Send a packet that one servo answers without data.

        Raises:
            DriveConnectionError: no intact answer in time, or the port is gone.
        """
        self._ask(packet, (servo_id,), 0, what)

    def exchange(
        self, goals: dict[int, dict[int, bytes]], servo_ids: tuple[int, ...], piece: Item
    ) -> list[StatusPacket]:
        """Write the goals of some servos, and read the same piece of the table of each, in one go.

        Args:
            goals: bytes by servo, by the address where they go; empty: nothing is written.
            servo_ids: whom to ask, in this order.
            piece: of the table.

        Raises:
            DriveConnectionError: no intact answer of each in time, or the port is gone.
            DriveStateError: a servo refuses.
        """
        frames, request = self._frames, self._requests.get((servo_ids, piece.address))
        if request is None:
            one = len(servo_ids) == 1
            request = (
                frames.read(servo_ids[0], piece.address, piece.size)
                if one
                else frames.sync_read(servo_ids, piece.address, piece.size)
            )
            self._requests[servo_ids, piece.address] = request
        if goals:
            request = b"".join(frames.sync_write(one, where) for where, one in goals.items()) + request
        return [self._taken(found, piece.name) for found in self._ask(request, servo_ids, piece.size, piece.name)]

    def shout(self, servo_id: int, item: Item, value: int) -> None:
        """Write an item of one byte, and wait for no answer. Never raises."""
        self._port.shout(self._frames.write(servo_id, item.address, bytes((value,))))

    def listen(self, request: bytes, wait_s: float) -> list[StatusPacket]:
        """Send a packet that nobody or many answer, and take what comes until nothing has for a time [s].

        Raises:
            DriveConnectionError: the port is gone.
        """
        heard = self._port.ask(request, 0)
        end_s = time.perf_counter() + wait_s
        while True:
            # once more after the time is over: a busy machine may have let it pass between the answer and the look
            is_over = time.perf_counter() >= end_s
            more = (b"" if is_over else self._port.read(1)) + self._port.arrived()
            heard += more
            if more:
                end_s = time.perf_counter() + wait_s
            elif is_over:
                return self._packets(heard)

    def _ask(self, request: bytes, servo_ids: tuple[int, ...], size: int, what: str) -> list[StatusPacket]:
        """Ask, asked again once where not everybody answered intact."""
        began_s, found = time.perf_counter(), "nothing"
        for _ in range(ATTEMPTS):
            reply = self._port.ask(request, (self._frames.status_bytes + size) * len(servo_ids))
            answers, found = self._apart(reply, servo_ids, size)
            if len(answers) == len(servo_ids):
                return answers
            self._port.rest(RESYNC_S)
            if time.perf_counter() >= self._deadline_s:
                break
        check = f"the id and the baud rate ({self._baud_rate})"
        raise no_answer(self._device(*servo_ids), f"{what}: found {found}", check, self._timeout_s, began_s, RESYNC_S)

    def _apart(self, reply: bytes, servo_ids: tuple[int, ...], size: int) -> tuple[list[StatusPacket], str]:
        """The answers of some servos in a row, and what was found where one of them is missing."""
        answers: list[StatusPacket] = []
        frames, start = self._frames, 0
        for place, servo_id in enumerate(servo_ids):
            length = frames.packet_bytes(reply[start : start + frames.status_bytes])
            if not length:
                return answers, _seen(reply, start)
            left = length + (frames.status_bytes + size) * (len(servo_ids) - place - 1) - (len(reply) - start)
            if left > 0:  # an answer is longer where it was stuffed
                reply += self._port.read(left)
            answer = frames.status(reply[start : start + length])
            if answer is None:
                return answers, "an answer with a wrong checksum: noise, or two servos of one id"
            # one that refuses has no data; what is refused is told by the caller
            if answer.servo_id != servo_id or (len(answer.data) != size and not frames.refusal(answer.error)):
                return answers, f"an answer of id {answer.servo_id}, {len(answer.data)} bytes"
            answers.append(answer)
            start += length
        return answers, ""

    def _device(self, *servo_ids: int) -> str:
        """The name used in messages."""
        return f"{self._name} id {', '.join(str(servo_id) for servo_id in servo_ids)}"

    def _packets(self, heard: bytes) -> list[StatusPacket]:
        """Every intact packet in what was heard."""
        frames, found, start = self._frames, [], 0
        while start < len(heard):
            length = frames.packet_bytes(heard[start:])
            answer = frames.status(heard[start : start + length]) if length else None
            if answer is not None:
                found.append(answer)
            start += 1 if answer is None else length
        return found

    def _taken(self, found: StatusPacket, what: str) -> StatusPacket:
        why = self._frames.refusal(found.error)
        if why:
            raise DriveStateError(self._device(found.servo_id), f"{what}: refused, {why}; see the servo's manual")
        return found


def _seen(reply: bytes, start: int) -> str:
    if len(reply) <= start:
        return "nothing"
    return f"{len(reply) - start} bytes that are no answer: noise, another baud rate, or two servos of one id"


def answering(port: str, baud_rate: int, frames: Frames, servo_ids: range | None) -> Iterator[StatusPacket]:
    """The answers to pings, which move nothing.

    Args:
        port: "/dev/ttyUSB0".
        baud_rate: of the line.
        frames: of the protocol.
        servo_ids: asked one after the other; None: everybody at once, where the protocol lets them answer in turn.

    Raises:
        DriveConnectionError: the port is not there, or in use.
    """
    bus = ServoBus(port, baud_rate, _ALONE_S if servo_ids else _ALL_S, frames)
    try:
        if servo_ids is None:
            yield from bus.listen(frames.ping(frames.broadcast), _ALL_S)
            return
        found: set[int] = set()
        # an answer that came late, through a slow adapter or on a busy host, is one all the same
        questions = [(frames.ping(servo_id), _ALONE_S) for servo_id in servo_ids]
        for question, wait_s in [*questions, (b"", _ALL_S)]:
            for one in bus.listen(question, wait_s):
                if one.servo_id in servo_ids and one.servo_id not in found:
                    found.add(one.servo_id)
                    yield one
    finally:
        bus.close()
