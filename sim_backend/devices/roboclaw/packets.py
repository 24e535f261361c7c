"""From bytes to commands. A packet does not say how long it is; its command does."""

from struct import unpack
from typing import NamedTuple

from sim_backend.devices.roboclaw.commands import COMMANDS


def _of_byte(byte: int) -> int:
    register = byte << 8
    for _ in range(8):
        register = (register << 1) ^ 0x1021 if register & 0x8000 else register << 1
    return register & 0xFFFF


_TABLE = tuple(_of_byte(byte) for byte in range(256))


def crc16(data: bytes) -> int:
    """Return the CRC of some bytes."""
    register = 0
    for byte in data:
        register = ((register << 8) & 0xFFFF) ^ _TABLE[(register >> 8) ^ byte]
    return register


LONGEST_GAP_S = 0.010
ADDRESSES = range(0x80, 0x88)
_HEAD = 2  # address, command
_CRC = 2


class Request(NamedTuple):
    """A valid packet.

    Attributes:
        head: address and command, which the CRC of an answer covers too.
        command: its number.
        values: the payload, unpacked.
    """

    head: bytes
    command: int
    values: tuple[int, ...]


class PacketReader:
    """Collects bytes, and drops what is not a packet.

    A pause of more than 10 ms ends a packet. After anything invalid the device hears nothing until such a pause: there
    is no other way to tell where the next packet begins.

    Args:
        addresses: to which it listens; over USB a RoboClaw takes any of 0x80 .. 0x87.
    """

    def __init__(self, addresses: frozenset[int]) -> None:
        self._addresses = addresses
        self._buffer = b""
        self._deaf = False
        self._last_s = -LONGEST_GAP_S

    def forget(self) -> None:
        """Drop half a packet."""
        self._buffer = b""
        self._deaf = False

    def feed(self, data: bytes, time_s: float) -> list[Request]:
        """Return the packets that are complete with bytes that arrived at a time [s]."""
        if time_s - self._last_s > LONGEST_GAP_S:
            self.forget()
        self._last_s = time_s
        requests = []
        self._buffer += data
        while not self._deaf and (request := self._take()):
            requests.append(request)
        if self._deaf:
            self._buffer = b""
        return requests

    def _take(self) -> Request | None:
        buffer = self._buffer
        if (buffer and buffer[0] not in self._addresses) or (len(buffer) >= _HEAD and buffer[1] not in COMMANDS):
            self._deaf = True
            return None
        if len(buffer) < _HEAD:
            return None
        command = COMMANDS[buffer[1]]
        end = _HEAD + command.payload_length
        length = end if command.reply else end + _CRC
        if len(buffer) < length:
            return None
        if not command.reply and crc16(buffer[:end]) != int.from_bytes(buffer[end:length]):
            self._deaf = True
            return None
        self._buffer = buffer[length:]
        return Request(buffer[:_HEAD], buffer[1], unpack(">" + command.payload, buffer[_HEAD:end]))
