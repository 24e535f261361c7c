"""A CAN-FD bus of python-can to controllers: frames out, frames in, in bounded time; several controllers in one go."""

import time
from collections.abc import Mapping

import can

from drivers.can_bus.port import EXTENDED, CanPort
from drivers.can_bus.settings import BusSettings
from drivers.errors import DriveConnectionError
from drivers.host_time import ATTEMPTS, no_answer
from drivers.moteus.text import padded

HOST = 0  # id of this host
_LONGEST_PLAIN = 0x7FF  # of identifiers of 11 bits


class MoteusCanLine:
    """An open bus.

    Raises:
        DriveConnectionError: it is not there, or does not open.
    """

    def __init__(self, settings: BusSettings, timeout_s: float) -> None:
        self._name, self._timeout_s = str(settings), timeout_s
        self._port = CanPort(settings)
        self._port.state_bits = EXTENDED  # an answer may have an identifier of 11 bits or of 29

    def close(self) -> None:
        """Close the bus. Never raises."""
        self._port.close()

    def ask(self, questions: Mapping[int, bytes], what: str) -> dict[int, bytes]:
        """Send a frame to each of some controllers, and take the answer of each.

        Raises:
            DriveConnectionError: one of them does not answer, or the adapter is gone.
        """
        began_s = time.perf_counter()
        answers = {answer_id(servo_id): servo_id for servo_id in questions}
        for _ in range(ATTEMPTS):
            self._port.drain()  # what comes late is no answer to this question
            before = {can_id: self._port.number(can_id) for can_id in answers}
            for servo_id, data in questions.items():
                self._port.send_prepared(_message(servo_id, data, True))
            missing = self._port.wait_beyond(before, self._timeout_s)
            if not missing:
                return {servo_id: self._data(can_id) for can_id, servo_id in answers.items()}
        silent = ", ".join(str(answers[can_id]) for can_id in missing)
        check = "servo_id, termination and the bit rates (1 and 5 Mbit/s)"
        raise no_answer(f"{self._name} servo {silent}", f"{what}: found no answer", check, self._timeout_s, began_s)

    def listen(self, questions: Mapping[int, bytes], wait_s: float) -> list[tuple[int, bytes]]:
        """Ask some controllers, of which any may not be there, or twice; every answer that comes within a time [s].

        Of several answers of one id the last is given as often as there were.

        Raises:
            DriveConnectionError: the adapter is gone.
        """
        self._port.drain()
        before = {servo_id: self._port.number(answer_id(servo_id)) for servo_id in questions}
        for servo_id, data in questions.items():
            self._port.send_prepared(_message(servo_id, data, True))
            self._port.drain()
        self._port.wait_for([-1], wait_s)  # which never comes
        found: list[tuple[int, bytes]] = []
        for servo_id, number in before.items():
            can_id = answer_id(servo_id)
            found += [(servo_id, self._data(can_id))] * (self._port.number(can_id) - number)
        return found

    def tell(self, servo_id: int, data: bytes) -> None:
        """Send a frame that is not answered. Never raises."""
        try:
            self._port.send_prepared(_message(servo_id, data, False))
        except DriveConnectionError:
            return

    def _data(self, can_id: int) -> bytes:
        heard = self._port.last(can_id)
        return b"" if heard is None else heard.data


def answer_id(servo_id: int) -> int:
    """Identifier of what a controller answers to the host with the id 0."""
    return servo_id << 8 | HOST


def _message(servo_id: int, data: bytes, wants_answer: bool) -> can.Message:
    """The frame; one whose identifier is too long for 11 bits has 29."""
    can_id = (0x8000 if wants_answer else 0) | HOST << 8 | servo_id
    return can.Message(
        arbitration_id=can_id,
        data=padded(data),
        is_extended_id=can_id > _LONGEST_PLAIN,
        is_fd=True,
        bitrate_switch=True,
    )
