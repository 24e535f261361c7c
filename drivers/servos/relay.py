"""A serial line of servos between another program and us: what it says passes, and in its pauses one servo is asked.

Only the other program commands. It is passed on byte for byte. A question of ours goes out when the line has been quiet
for a moment and nothing is owed to the other program. Where that program falls silent we do, too: a question feeds a
bus watchdog as well as a command does, and the silence of who commands has to stop the motor.
"""

import os
import pty
import select
import tty
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from time import perf_counter
from typing import TypeVar

from drivers.actuator.reading import Reading, sample_of
from drivers.contract import Sample, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError
from drivers.joint import JointScale
from drivers.serial_port import SerialPort
from drivers.servos.actuator import ServoSettings
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Frames, Item

_MOST_BYTES = 4096
ModelT = TypeVar("ModelT")
_QUIET_S = 0.002  # of the line, before a question of ours
_OWED_S = 0.1  # longest wait for an answer to the other program: an adapter, or a busy host, may hold one back
_ALIVE_S = 0.2  # who says nothing for longer counts as silent


class OfferedPort:
    """Our end of it.

    Args:
        link: a name for the other end, so that it can be written into that program's settings.

    Raises:
        DriveConnectionError: something that is no link of ours has the name.
    """

    def __init__(self, link: Path) -> None:
        if link.exists() and not link.is_symlink():
            raise DriveConnectionError(str(link), "is there already, and is no link; offer the port by another name")
        self._link = link
        self._ours, self._theirs = pty.openpty()  # their end stays open here: who goes is silent, and no error
        tty.setraw(self._theirs)
        os.set_blocking(self._ours, False)
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._theirs))

    def fileno(self) -> int:
        """For `select`."""
        return self._ours

    def take(self) -> bytes:
        """What the other program has written."""
        try:
            return os.read(self._ours, _MOST_BYTES)
        except BlockingIOError:
            return b""

    def give(self, data: bytes) -> None:
        """Let the other program read something; what it has no room for is lost, as on a wire."""
        with suppress(BlockingIOError):
            os.write(self._ours, data)

    def close(self) -> None:
        """Take it away. Safe to call twice."""
        self._link.unlink(missing_ok=True)
        for descriptor in (self._ours, self._theirs):
            with suppress(OSError):
                os.close(descriptor)


class ServoFollower:
    """A servo that another program moves, looked at in the pauses of the line.

    Args:
        settings: who is looked at, and on which real port.
        frames: of the protocol.
        piece: what is read of it.
        link: name of the port that is offered.
        period_s: from one look to the next, at least [s].
        product: what answers.
        reading: the piece in SI, of its bytes and when it was asked for.
        joint: scales and signs.

    Raises:
        DriveConnectionError: the real port is not there, or in use.
    """

    is_between = True

    def __init__(
        self, settings: ServoSettings, frames: Frames, piece: Item, link: Path, period_s: float, product: str,
        reading: Callable[[bytes, float], Reading], joint: JointScale,
    ) -> None:  # fmt: skip
        servo_id, port = settings.servo_id, settings.port
        self.product, self.device = product, settings.device
        self.wanted = f"open {link} in the place of the real port, and leave the line a pause of 2 ms at times"
        self._reading, self._joint = reading, joint
        self._frames, self._servo_id, self._period_s = frames, servo_id, period_s
        self._question = frames.read(servo_id, piece.address, piece.size)
        self._piece_bytes, self._answer_bytes = piece.size, frames.status_bytes + piece.size
        self._line = SerialPort(port, port, settings.baud_rate, settings.answer_timeout_s)
        try:
            self._other = OfferedPort(link)
        except BaseException:
            self._line.close()
            raise
        self._owes = False
        self._said_s = float("-inf")  # by the other program
        self._line_s = self._looked_s = 0.0

    @property
    def silent_s(self) -> float:
        """How long the other program has said nothing [s]."""
        return perf_counter() - self._said_s

    def look(self, timeout_s: float) -> Sample | None:
        """Pass on what is said for a while [s]; return a sample as soon as one was taken, else None."""
        end_s = perf_counter() + timeout_s
        while (now_s := perf_counter()) < end_s:
            self._pass_on(min(end_s, now_s + _QUIET_S) - now_s)
            if self._is_due():
                found = self._ask()
                if found is not None:
                    reading = self._reading(*found)
                    return sample_of(reading, self._joint, Status.ENABLED if reading.is_on else Status.DISABLED)
        return None

    def close(self) -> None:
        """Give both ports back. Never raises."""
        self._other.close()
        self._line.close()

    def _pass_on(self, wait_s: float) -> None:
        other, line = self._other.fileno(), self._line.fileno()
        ready, _, _ = select.select([other, line], [], [], wait_s)
        if other in ready:
            said = self._other.take()
            if said:
                self._line.shout(said)
                self._said_s = perf_counter()
                self._owes = not self._frames.nobody_answers(said)
        if line in ready:
            self._hand_over(self._line.read(1) + self._line.arrived())

    def _hand_over(self, heard: bytes) -> None:
        if heard:
            self._other.give(heard)
            self._line_s, self._owes = perf_counter(), False

    def _is_due(self) -> bool:
        now_s = perf_counter()
        silent_s = now_s - self._said_s
        if silent_s > _ALIVE_S or now_s - self._looked_s < self._period_s:
            return False
        if self._owes and silent_s < _OWED_S:
            return False
        return silent_s >= _QUIET_S and now_s - self._line_s >= _QUIET_S

    def _ask(self) -> tuple[bytes, float] | None:
        """The piece; what is no answer to us is the other program's."""
        asked_s = self._looked_s = perf_counter()
        frames, heard = self._frames, self._line.ask(self._question, self._answer_bytes)
        while length := frames.packet_bytes(heard[: frames.status_bytes]):
            if length > len(heard):  # an answer is longer where it was stuffed
                heard += self._line.read(length - len(heard))
            packet, heard = heard[:length], heard[length:]
            answer = frames.status(packet)
            if answer and answer.servo_id == self._servo_id and len(answer.data) == self._piece_bytes:
                self._hand_over(heard)
                self._line_s = perf_counter()
                return answer.data, asked_s
            self._hand_over(packet)  # one that was late
            heard += self._line.read(self._answer_bytes - len(heard))
        self._hand_over(heard)
        return None


def asked_model(settings: ServoSettings, frames: Frames, item: Item, models: Mapping[int, ModelT]) -> ModelT:
    """Ask a servo for its model, before the other program is there.

    Raises:
        DriveConnectionError: the port is not there or in use, or nobody answers.
        DriveConfigurationError: a model whose numbers nobody here knows the meaning of.
    """
    bus = ServoBus(settings.port, settings.baud_rate, settings.answer_timeout_s, frames)
    try:
        bus.begin()
        number = bus.read(settings.servo_id, item)
    finally:
        bus.close()
    if number not in models:
        raise DriveConfigurationError(
            settings.device, f"its model number is {number}, which is not known; check servo_id"
        )
    return models[number]
