"""Packets of the driver and of the simulated servo, beside those of the e-Manual and of ROBOTIS' own library."""

import pytest
from dynamixel_sdk import PacketHandler
from hypothesis import given
from hypothesis import strategies as st

from drivers.dynamixel import frames
from drivers.servos.frames import StatusPacket
from sim_backend.devices.dynamixel import packets

# e-Manual, "DYNAMIXEL Protocol 2.0": instruction packets and the status packets that answer them
MANUAL = {
    "ping": (frames.packet(1, frames.PING), "ff ff fd 00 01 03 00 01 19 4e"),
    "read": (frames.read_packet(1, 132, 4), "ff ff fd 00 01 07 00 02 84 00 04 00 1d 15"),
    "write": (
        frames.write_packet(1, 116, (512).to_bytes(4, "little")),
        "ff ff fd 00 01 09 00 03 74 00 00 02 00 00 ca 89",
    ),
    "reboot": (frames.packet(1, frames.REBOOT), "ff ff fd 00 01 03 00 08 2f 4e"),
    "sync read": (frames.sync_read_packet((1, 2), 132, 4), "ff ff fd 00 fe 09 00 82 84 00 04 00 01 02 ce fa"),
    "sync write": (
        frames.sync_write_packet({1: (150).to_bytes(4, "little"), 2: (170).to_bytes(4, "little")}, 116),
        "ff ff fd 00 fe 11 00 83 74 00 04 00 01 96 00 00 00 02 aa 00 00 00 82 87",
    ),
}
ANSWER = bytes.fromhex("ff ff fd 00 01 08 00 55 00 a6 00 00 00 8c c0")
BYTES = st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x55]), max_size=20).map(bytes)


class Wire:
    """The port of ROBOTIS' library, with what it has sent."""

    is_using, sent = False, b""

    def clearPort(self):  # noqa: N802
        """Nothing waits."""

    def writePort(self, packet):  # noqa: N802
        self.sent = bytes(packet)
        return len(packet)


@pytest.mark.parametrize("name", MANUAL)
def test_packets_of_the_manual(name):
    made, wanted = MANUAL[name]
    assert made.hex(" ") == wanted


def test_an_answer_of_the_manual():
    assert frames.status(ANSWER) == StatusPacket(1, 0, bytes.fromhex("a6 00 00 00"))
    assert packets.status(1, 0, bytes.fromhex("a6 00 00 00")) == ANSWER


def test_an_answer_with_a_flipped_bit_is_none():
    for place in range(7, len(ANSWER)):
        spoilt = bytearray(ANSWER)
        spoilt[place] ^= 1
        assert frames.status(bytes(spoilt)) is None


@given(BYTES.filter(lambda data: b"\xff\xff\xfd" not in data))
def test_packets_are_those_of_the_makers_library(data):
    """But for stuffing: `dynamixel-sdk` 4.1 works the stuffed packet out, and sends the other (`addStuffing`)."""
    wire = Wire()
    PacketHandler(2.0).writeTxOnly(wire, 1, 200, len(data), list(data))
    assert frames.write_packet(1, 200, data) == wire.sent


@given(BYTES)
def test_answers_survive_stuffing_both_ways(data):
    answer = packets.status(7, 0x80, data)
    assert frames.packet_bytes(answer) == len(answer)
    assert frames.status(answer) == StatusPacket(7, 0x80, data)


@given(BYTES)
def test_the_simulated_servo_hears_what_was_sent(data):
    sent = frames.write_packet(3, 200, data)
    [heard] = packets.InstructionReader().feed(b"\xff\x00" + sent, 0.0)
    assert heard == packets.Instruction(3, 3, b"\xc8\x00" + data)
