"""From bytes to instruction packets, and from status to bytes (e-Manual, "DYNAMIXEL Protocol 2.0")."""

from typing import NamedTuple

_START = b"\xff\xff\xfd"
_HEAD = 7  # FF FF FD, reserved, id, length of two bytes
_LONGEST = 1024
LONGEST_GAP_S = 0.05
EVERYBODY = 0xFE


def checksum(data: bytes) -> int:
    """Return the CRC of some bytes: polynomial 0x8005, bit by bit as the manual defines it."""
    remainder = 0
    for byte in data:
        remainder ^= byte << 8
        for _ in range(8):
            remainder = ((remainder << 1) ^ 0x8005 if remainder >> 15 else remainder << 1) & 0xFFFF
    return remainder


class _Table:
    """The same, a byte at a time."""

    words = tuple(checksum(bytes((byte,))) for byte in range(256))


def quick_checksum(data: bytes) -> int:
    """Return the CRC of some bytes, by table."""
    remainder = 0
    for byte in data:
        remainder = (remainder << 8 & 0xFF00) ^ _Table.words[remainder >> 8 ^ byte]
    return remainder


class Instruction(NamedTuple):
    """A valid packet of a host."""

    servo: int
    code: int
    parameters: bytes


def stuffed(body: bytes) -> bytes:
    """Return a body in which no header begins."""
    made = bytearray()
    for byte in body:
        made.append(byte)
        if made[-3:] == _START:
            made.append(0xFD)
    return bytes(made)


def unstuffed(body: bytes) -> bytes:
    """Return a body without what was stuffed in."""
    made = bytearray()
    skip = False
    for byte in body:
        if skip and byte == 0xFD:
            skip = False
            continue
        made.append(byte)
        skip = made[-3:] == _START
    return bytes(made)


def status(servo: int, error: int, parameters: bytes = b"") -> bytes:
    """Return a status packet."""
    body = stuffed(bytes((0x55, error)) + parameters)
    whole = _START + bytes((0, servo, len(body) + 2 & 0xFF, len(body) + 2 >> 8)) + body
    remainder = quick_checksum(whole)
    return whole + bytes((remainder & 0xFF, remainder >> 8))


class InstructionReader:
    """Collects bytes, and drops what is not an instruction packet: noise before a header, a wrong CRC, a long gap."""

    def __init__(self) -> None:
        self._buffer = b""
        self._last_s = 0.0

    def forget(self) -> None:
        """Drop half a packet."""
        self._buffer = b""

    def feed(self, data: bytes, time_s: float) -> list[Instruction]:
        """Return the packets that are complete with bytes that arrived at a time [s]."""
        if time_s - self._last_s > LONGEST_GAP_S:
            self._buffer = b""
        self._last_s = time_s
        self._buffer += data
        found: list[Instruction] = []
        while True:
            start = self._buffer.find(_START)
            if start < 0:
                self._buffer = self._buffer[-2:]
                return found
            self._buffer = self._buffer[start:]
            if len(self._buffer) < _HEAD:
                return found
            end = _HEAD + self._buffer[5] + 256 * self._buffer[6]
            if end > _LONGEST:
                self._buffer = self._buffer[3:]
                continue
            if len(self._buffer) < end:
                return found
            whole, self._buffer = self._buffer[:end], self._buffer[end:]
            if end > _HEAD + 2 and quick_checksum(whole[:-2]) == whole[-2] + 256 * whole[-1]:
                body = unstuffed(whole[_HEAD:-2])
                found.append(Instruction(whole[4], body[0], body[1:]))
