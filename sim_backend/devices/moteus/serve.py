"""Starts moteus controllers behind an adapter on a pseudo-terminal, or on a CAN-FD bus without one.

The adapter's text: `can send ID DATA FLAGS` in, OK and `rcv ID DATA FLAGS` out.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from threading import RLock

from sim_backend.devices.axis import Device
from sim_backend.devices.can.frame import Frame, QuietNode
from sim_backend.devices.can.ports import port_of
from sim_backend.devices.link.serial_port import ServedOnLine
from sim_backend.devices.moteus.controller import MoteusController
from sim_backend.devices.process import RunningDevice

_LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)
_TABLE = (
    0x00, 0x97, 0xB9, 0x2E, 0xE5, 0x72, 0x5C, 0xCB, 0x5D, 0xCA, 0xE4, 0x73, 0xB8, 0x2F, 0x01, 0x96,
)  # fmt: skip
_LONGEST = 512


class Controllers(Device):
    """The controllers of a bus. Loads, faults and truth are the first one's."""

    def __init__(self, controllers: Sequence[MoteusController]) -> None:
        self.axis = controllers[0].axis
        self.lock = RLock()
        self._controllers = controllers

    def advance_to(self, time_s: float) -> None:
        """Let time pass."""
        for one in self._controllers:
            one.axis.advance_to(time_s)

    def report(self) -> dict[str, object]:
        """Say what the first controller is about."""
        return self._controllers[0].report()

    def answers(self, can_id: int, data: bytes) -> Iterator[tuple[int, bytes]]:
        """Yield identifier and data of each frame that answers one."""
        source, destination = can_id >> 8 & 0x7F, can_id & 0x7F
        for one in self._controllers:
            if one.servo_id == destination:
                answer = one.hear(data, bool(can_id & 0x8000))
                if answer:
                    yield one.servo_id << 8 | source, padded(answer)


class FdcanusbAdapter(Controllers):
    """Bytes of a host to the controllers, and back."""

    def __init__(self, controllers: Sequence[MoteusController], is_uart: bool = False) -> None:
        super().__init__(controllers)
        self._is_uart = is_uart
        self._text = b""

    def connect(self) -> None:
        """Forget half a line."""
        self._text = b""

    def receive(self, data: bytes, time_s: float) -> bytes:  # noqa: ARG002
        """Take bytes; return the lines that answer."""
        *lines, self._text = (self._text + data).replace(b"\r", b"\n").split(b"\n")
        self._text = self._text[-_LONGEST:]
        return b"".join(self._obey(line) for line in lines if line.strip())

    def _obey(self, line: bytes) -> bytes:
        star = line.rfind(b"*")
        if star >= 0:
            if line[star + 1 : star + 3].upper() != b"%02X" % _crc(line[:star]):
                return self._line(b"ERR checksum mismatch")
            line = line[:star]
        elif self._is_uart:
            return self._line(b"ERR missing checksum")
        words = line.split()
        if len(words) < 4 or words[:2] != [b"can", b"send"]:
            return self._line(b"ERR unknown command")
        try:
            can_id, data = int(words[2], 16), bytes.fromhex(words[3].decode("ascii"))
        except ValueError:
            return self._line(b"ERR malformed frame")
        if len(data) not in _LENGTHS:
            return self._line(b"ERR malformed frame")
        answers = ((answer_id, told.hex().upper().encode("ascii")) for answer_id, told in self.answers(can_id, data))
        return self._line(b"OK") + b"".join(self._line(b"rcv %X %s E B F" % answer) for answer in answers)

    def _line(self, text: bytes) -> bytes:
        if self._is_uart:
            text += b" "
            text += b"*%02X" % _crc(text)
        return text + b"\r\n"


def padded(data: bytes) -> bytes:
    """Return data as long as a frame may be; what is beyond the longest is not sent."""
    data = data[: _LENGTHS[-1]]
    return data.ljust(next(size for size in _LENGTHS if size >= len(data)), b"\x50")


def _crc(data: bytes) -> int:
    crc = 0
    for byte in data:
        crc = _TABLE[(crc >> 4 ^ byte >> 4) & 15] ^ crc << 4 & 0xFF
        crc = _TABLE[(crc >> 4 ^ byte & 15) & 15] ^ crc << 4 & 0xFF
    return crc


@dataclass(frozen=True, kw_only=True)
class MoteusBusSettings(ServedOnLine):
    """Controllers, their joints and their adapter.

    Attributes:
        ids: of each.
        interface, channel: a CAN-FD bus of python-can in the place of the adapter; "": the adapter.
        is_uart: whether it is a controller's own UART, whose lines have checksums.
    """

    ids: tuple[int, ...] = (1,)
    interface: str = ""
    channel: str = ""
    is_uart: bool = False


class MoteusOnBus(Controllers):
    """The controllers without an adapter."""

    def __init__(self, controllers: Sequence[MoteusController]) -> None:
        super().__init__(controllers)
        self.node = QuietNode()

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        for can_id, data in self.answers(frame.can_id, frame.data) if frame.fd else ():
            self.node.send(Frame(can_id, data, extended=True, fd=True))


def serve_moteus(settings: MoteusBusSettings) -> RunningDevice:
    """Start them.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    parameters = settings.joint()
    controllers = [
        MoteusController(parameters, servo_id, settings.seed + place) for place, servo_id in enumerate(settings.ids)
    ]
    if settings.interface:
        on_bus = MoteusOnBus(controllers)
        return settings.running(on_bus, port_of(on_bus, settings, settings.interface, settings.channel))
    return settings.on_pseudo_terminal(FdcanusbAdapter(controllers, settings.is_uart))
