"""From bytes to instruction packets of the SCS protocol, and from status to bytes."""

from typing import NamedTuple

_START = 0xFF
_SHORTEST = 6  # FF FF, id, length, instruction, checksum
LONGEST_GAP_S = 0.05
EVERYBODY = 0xFE


class Instruction(NamedTuple):
    """A valid packet of a host."""

    servo: int
    code: int
    parameters: bytes


def sum_of(body: bytes) -> int:
    """Return the checksum of id, length, instruction or error, and parameters."""
    total = 0
    for byte in body:
        total = total + byte & 0xFF
    return total ^ 0xFF


def status(servo: int, error: int, parameters: bytes = b"") -> bytes:
    """Return a status packet."""
    body = bytes((servo, 2 + len(parameters), error)) + parameters
    return bytes((_START, _START)) + body + bytes((sum_of(body),))


class InstructionReader:
    """Collects bytes, and drops what is not an instruction packet: noise, a wrong checksum, a long gap."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._last_s = 0.0

    def forget(self) -> None:
        """Drop half a packet."""
        self._buffer.clear()

    def feed(self, data: bytes, time_s: float) -> list[Instruction]:
        """Return the packets that are complete with bytes that arrived at a time [s]."""
        if time_s - self._last_s > LONGEST_GAP_S:
            self._buffer.clear()
        self._last_s = time_s
        self._buffer += data
        found: list[Instruction] = []
        while self._skip_noise():
            length = self._buffer[3]
            end = 4 + length
            if length < 2:
                del self._buffer[:2]
                continue
            if len(self._buffer) < end:
                break
            whole = bytes(self._buffer[:end])
            if sum_of(whole[2:-1]) != whole[-1]:
                del self._buffer[:2]
                continue
            del self._buffer[:end]
            found.append(Instruction(whole[2], whole[4], whole[5:-1]))
        return found

    def _skip_noise(self) -> bool:
        """Take away what comes before a header; tell whether one is there."""
        buffer = self._buffer
        while len(buffer) >= 2 and not (buffer[0] == buffer[1] == _START and (len(buffer) < 3 or buffer[2] != _START)):
            del buffer[0]
        return len(buffer) >= _SHORTEST
