"""Lines of the fdcanusb adapter, which a moteus speaks on its UART, too. Pure functions.

`can send ID DATA FLAGS` is answered with OK, and a frame on the bus is `rcv ID DATA FLAGS`. Over UART a line ends in
`*XX`, the CRC-8 (polynomial 0x97) of all before the asterisk.

Source: mjbots, "fdcanusb" and "UART" of the moteus documentation; lines compared with those of `moteus` 1.1.
"""

from typing import NamedTuple

_POLYNOMIAL = 0x97
_LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)  # of CAN-FD frames
_PADDING = b"\x50"  # a subframe that means nothing
LONGEST_LINE = 512


class Received(NamedTuple):
    """A frame from the bus."""

    can_id: int
    data: bytes


def crc8(data: bytes) -> int:
    """Of everything before the asterisk."""
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ _POLYNOMIAL) & 0xFF if crc & 0x80 else crc << 1
    return crc


def padded(data: bytes) -> bytes:
    """Data as long as a frame of CAN-FD may be; what is added means nothing."""
    return data.ljust(next(one for one in _LENGTHS if one >= len(data)), _PADDING)


def send_line(can_id: int, data: bytes, has_checksum: bool) -> bytes:
    """The line that puts a frame on the bus, with the fast bit rate of CAN-FD."""
    line = b"can send %04x %s BF" % (can_id, padded(data).hex().encode("ascii"))
    if has_checksum:
        line += b" "
        line += b"*%02X" % crc8(line)
    return line + b"\n"


def received(line: bytes, has_checksum: bool) -> Received | None:
    """The frame of a line; None where it is another line, or not intact."""
    star = line.rfind(b"*")
    if has_checksum:
        if star < 0 or line[star + 1 :].strip() != b"%02X" % crc8(line[:star]):
            return None
        line = line[:star]
    words = line.split()
    if len(words) < 3 or words[0] != b"rcv":
        return None
    try:
        return Received(int(words[1], 16), bytes.fromhex(words[2].decode("ascii")))
    except ValueError:
        return None
