"""Packets as bytes: pure functions.

A write is `address, command, data, CRC` and answered with 0xFF, or not at all where the CRC is wrong. A read is
`address, command`, without CRC, and answered with `data, CRC`; that CRC is over address, command and data. The CRC is
CRC-16/XMODEM (polynomial 0x1021, start 0, neither reflected nor inverted), high byte first.
"""

from binascii import crc_hqx

from drivers.roboclaw.commands import CRC_BYTES, READ_VERSION, Read, Write

VERSION_END = b"\n\0"


def crc16(data: bytes) -> int:
    """CRC-16/XMODEM; of b"123456789" it is 0x31C3."""
    return crc_hqx(data, 0)


def write_packet(address: int, command: Write, *values: int) -> bytes:
    """The bytes of a write.

    Args:
        address: 0x80 .. 0x87.
        command: from the table.
        values: as its layout wants them.
    """
    packet = bytes((address, command.number)) + command.layout.pack(*values)
    return packet + crc16(packet).to_bytes(2, "big")


def read_packet(address: int, command: Read) -> bytes:
    """The bytes of a read."""
    return bytes((address, command.number))


def version_packet(address: int) -> bytes:
    """The bytes that ask for the firmware version."""
    return bytes((address, READ_VERSION))


def is_intact(request_crc: int, reply: bytes) -> bool:
    """Whether the CRC at the end of a reply to a read is right."""
    # of data followed by its own CRC, the CRC is 0
    return len(reply) > CRC_BYTES and crc_hqx(reply, request_crc) == 0
