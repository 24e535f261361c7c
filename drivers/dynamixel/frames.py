"""Packets of protocol 2.0 as bytes: pure functions.

`FF FF FD 00, id, length (2), instruction, parameters, CRC (2)`, low byte first; a status packet has instruction 0x55
and an error byte before its parameters. The length counts all that follows it. Inside instruction and parameters an
FD is put after each FF FF FD, so that a header is always one. The CRC is CRC-16/BUYPASS (polynomial 0x8005, start 0,
neither reflected nor inverted) over everything before it.

Source: ROBOTIS e-Manual, "DYNAMIXEL Protocol 2.0".
"""

from drivers.servos.frames import Frames, StatusPacket

HEADER = b"\xff\xff\xfd\x00"
HEAD_BYTES = 7  # header, id, length
STATUS_BYTES = 11  # of a status packet without parameters
BROADCAST = 0xFE
PING, READ, WRITE, ACTION, REBOOT, STATUS, SYNC_READ, SYNC_WRITE = 0x01, 0x02, 0x03, 0x05, 0x08, 0x55, 0x82, 0x83
BULK_WRITE = 0x93
ALERT = 0x80  # in the error byte: there is a hardware error
_CRC_BYTES = 2
_STUFFED, _STUFFING = b"\xff\xff\xfd", b"\xff\xff\xfd\xfd"


def _of_byte(byte: int) -> int:
    register = byte << 8
    for _ in range(8):
        register = (register << 1) ^ 0x8005 if register & 0x8000 else register << 1
    return register & 0xFFFF


_TABLE = tuple(_of_byte(byte) for byte in range(256))


def crc16(data: bytes) -> int:
    """CRC-16/BUYPASS; of b"123456789" it is 0xFEE8."""
    register, table = 0, _TABLE
    for byte in data:
        register = ((register << 8) & 0xFFFF) ^ table[(register >> 8) ^ byte]
    return register


def packet(servo_id: int, instruction: int, parameters: bytes = b"") -> bytes:
    """The bytes of an instruction packet."""
    body = (bytes((instruction,)) + parameters).replace(_STUFFED, _STUFFING)
    head = HEADER + bytes((servo_id,)) + (len(body) + _CRC_BYTES).to_bytes(2, "little") + body
    return head + crc16(head).to_bytes(2, "little")


def read_packet(servo_id: int, address: int, size: int) -> bytes:
    """Ask one servo for bytes of its control table."""
    return packet(servo_id, READ, address.to_bytes(2, "little") + size.to_bytes(2, "little"))


def write_packet(servo_id: int, address: int, data: bytes) -> bytes:
    """Write bytes into the control table of one servo."""
    return packet(servo_id, WRITE, address.to_bytes(2, "little") + data)


def sync_read_packet(servo_ids: tuple[int, ...], address: int, size: int) -> bytes:
    """Ask several servos for the same bytes; each answers in turn."""
    return packet(BROADCAST, SYNC_READ, address.to_bytes(2, "little") + size.to_bytes(2, "little") + bytes(servo_ids))


def sync_write_packet(demands: dict[int, bytes], address: int) -> bytes:
    """Write bytes into the same place of several servos; none answers."""
    size = len(next(iter(demands.values())))
    parts = b"".join(bytes((servo_id,)) + data for servo_id, data in demands.items())
    return packet(BROADCAST, SYNC_WRITE, address.to_bytes(2, "little") + size.to_bytes(2, "little") + parts)


def packet_bytes(reply: bytes) -> int:
    """Length of the packet that begins so; 0 where it is no packet."""
    if len(reply) < HEAD_BYTES or not reply.startswith(HEADER):
        return 0
    return HEAD_BYTES + reply[5] + (reply[6] << 8)


def status(reply: bytes) -> StatusPacket | None:
    """Take a whole status packet apart; None where it is not intact."""
    # of bytes followed by their own CRC, low byte first, that CRC is compared: it is not 0 as with the high byte first
    if len(reply) < STATUS_BYTES or reply[HEAD_BYTES] != STATUS:
        return None
    if crc16(reply[:-_CRC_BYTES]) != reply[-2] | reply[-1] << 8:
        return None
    body = reply[HEAD_BYTES + 1 : -_CRC_BYTES].replace(_STUFFING, _STUFFED)
    return StatusPacket(reply[4], body[0], body[1:])


def nobody_answers(request: bytes) -> bool:
    """Whether the last packet is one to everybody that asks for nothing."""
    last = request[max(request.rfind(HEADER), 0) :]
    to_all = len(last) > HEAD_BYTES and last[4] == BROADCAST
    return to_all and last[HEAD_BYTES] in (ACTION, SYNC_WRITE, BULK_WRITE)


_REFUSALS = {
    1: "it failed to do it", 2: "it does not know the instruction", 3: "the CRC was wrong", 4: "out of range",
    5: "of another length", 6: "beyond its limit", 7: "not to be written now",
}  # fmt: skip


def refusal(error: int) -> str:
    """What an error byte says, the alert aside; "" where it refuses nothing."""
    number = error & ~ALERT
    return _REFUSALS.get(number, f"error {number}") if number else ""


PROTOCOL_2 = Frames(
    STATUS_BYTES, read_packet, write_packet, sync_read_packet, sync_write_packet, packet_bytes, status, refusal,
    lambda servo_id: packet(servo_id, PING), BROADCAST, nobody_answers,
)  # fmt: skip
