"""Packets of the SCS protocol as bytes: pure functions.

`FF FF, id, length, instruction, parameters, checksum`; a status packet has an error byte in the place of the
instruction. The length counts all that follows it. The checksum is the complement of the sum of id to parameters.

Source: Feetech, "SCS protocol manual"; bytes compared with those of `ftservo-python-sdk` 2.0.
"""

from drivers.servos.frames import Frames, StatusPacket

HEADER = b"\xff\xff"
STATUS_BYTES = 6
BROADCAST = 0xFE
PING, READ, WRITE, ACTION, SYNC_READ, SYNC_WRITE = 0x01, 0x02, 0x03, 0x05, 0x82, 0x83
_HEAD_BYTES = 4  # header, id, length


def checksum(body: bytes) -> int:
    """Of everything between header and checksum."""
    return ~sum(body) & 0xFF


def packet(servo_id: int, instruction: int, parameters: bytes = b"") -> bytes:
    """The bytes of an instruction packet."""
    body = bytes((servo_id, len(parameters) + 2, instruction)) + parameters
    return HEADER + body + bytes((checksum(body),))


def read_packet(servo_id: int, address: int, size: int) -> bytes:
    """Ask one servo for bytes of its memory."""
    return packet(servo_id, READ, bytes((address, size)))


def write_packet(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes into the memory of one servo."""
    return packet(servo_id, WRITE, bytes((address,)) + data)


def sync_read_packet(servo_ids: tuple[int, ...], address: int, size: int) -> bytes:
    """Ask several servos for the same bytes; each answers in turn."""
    return packet(BROADCAST, SYNC_READ, bytes((address, size)) + bytes(servo_ids))


def sync_write_packet(goals: dict[int, bytes], address: int) -> bytes:
    """Write bytes into the same place of several servos; none answers."""
    size = len(next(iter(goals.values())))
    parts = b"".join(bytes((servo_id,)) + data for servo_id, data in goals.items())
    return packet(BROADCAST, SYNC_WRITE, bytes((address, size)) + parts)


def packet_bytes(reply: bytes) -> int:
    """Length of the packet that begins so; 0 where it is no packet."""
    if len(reply) < STATUS_BYTES or not reply.startswith(HEADER) or reply[3] < 2:
        return 0
    return _HEAD_BYTES + reply[3]


def status(reply: bytes) -> StatusPacket | None:
    """Take a whole status packet apart; None where it is not intact."""
    if len(reply) < STATUS_BYTES or checksum(reply[2:-1]) != reply[-1]:
        return None
    return StatusPacket(reply[2], reply[4], reply[5:-1])


def nobody_answers(request: bytes) -> bool:
    """Whether the last packet is one to everybody that asks for nothing."""
    last = request[max(request.rfind(HEADER), 0) :]
    return len(last) > _HEAD_BYTES and last[2] == BROADCAST and last[4] in (ACTION, SYNC_WRITE)


def signed(word: int, sign_bit: int) -> int:
    """A number whose sign is a bit of its own."""
    magnitude = word & (1 << sign_bit) - 1
    return -magnitude if word & 1 << sign_bit else magnitude


def with_sign(value: int, sign_bit: int) -> int:
    """The word of a number whose sign is a bit of its own."""
    return -value | 1 << sign_bit if value < 0 else value


SCS = Frames(
    STATUS_BYTES, read_packet, write_packet, sync_read_packet, sync_write_packet, packet_bytes, status,
    lambda _error: "",  # its error byte tells of the servo's state; nothing is refused
    lambda servo_id: packet(servo_id, PING), BROADCAST, nobody_answers,
)  # fmt: skip
