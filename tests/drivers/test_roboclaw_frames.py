"""Packets of RoboClaw packet serial against bytes worked out by hand from the manual."""

import pytest

from drivers.polled_drive import Identity
from drivers.roboclaw import commands
from drivers.roboclaw.link import crc16, is_intact, read_packet, version_packet, write_packet
from drivers.roboclaw.opening import parse_version
from drivers.roboclaw.telemetry import FLAGS_16_BIT, FLAGS_32_BIT, EncoderCount, faults
from tests.drivers.roboclaw_answers import crc

M1 = commands.CHANNELS[1]


def test_the_check_value_of_the_crc():
    assert crc16(b"123456789") == 0x31C3
    assert crc(b"123456789") == b"\x31\xc3"


@pytest.mark.parametrize(
    ("packet", "wanted"),
    [
        (write_packet(0x80, M1.set_duty, 0), "80 20 00 00 5b fe"),
        (write_packet(0x80, M1.set_duty, 16384), "80 20 40 00 56 32"),
        (write_packet(0x87, commands.CHANNELS[2].set_duty, -32767), "87 21 80 01 36 5a"),
        (write_packet(0x80, commands.SET_TIMEOUT, 2), "80 0e 02 38 17"),
        (read_packet(0x80, M1.encoder), "80 10"),
        (read_packet(0x81, commands.CURRENTS), "81 31"),
        (version_packet(0x80), "80 15"),
    ],
)
def test_what_is_sent(packet, wanted):
    assert packet.hex(" ") == wanted


def test_what_is_sent_carries_the_crc_of_the_polynomial():
    packet = write_packet(0x80, M1.set_duty, 16384)
    assert packet[-2:] == crc(packet[:-2])


# encoder 305419896, moving backward; the CRC covers 80 10 too
ENCODER_ANSWER = bytes.fromhex("12 34 56 78 02") + crc(bytes.fromhex("80 10 12 34 56 78 02"))


def test_an_answer_is_intact_only_with_the_crc_of_question_and_data():
    assert ENCODER_ANSWER.hex(" ") == "12 34 56 78 02 5a 60"
    assert is_intact(crc16(b"\x80\x10"), ENCODER_ANSWER)
    assert M1.encoder.layout.unpack_from(ENCODER_ANSWER) == (305419896, 2)
    assert not is_intact(crc16(b"\x80\x11"), ENCODER_ANSWER)
    assert not is_intact(crc16(b"\x81\x10"), ENCODER_ANSWER)
    assert not is_intact(crc16(b"\x80\x10"), b"")
    for place in range(len(ENCODER_ANSWER)):
        for bit in range(8):
            wrong = bytearray(ENCODER_ANSWER)
            wrong[place] ^= 1 << bit
            assert not is_intact(crc16(b"\x80\x10"), bytes(wrong))


def test_the_count_is_followed_through_its_wraps():
    encoder = EncoderCount(0xFFFFFFFE)
    assert encoder.counts == -2
    assert [encoder.follow(reading) for reading in (0xFFFFFFFF, 0, 5, 0xFFFFFFF0)] == [-1, 0, 5, -16]
    high = EncoderCount(0x7FFFFFFF)
    assert high.follow(0x80000001) == 0x80000001


def test_faults_by_name_in_both_layouts():
    assert faults(0x0000_0041, FLAGS_32_BIT, 1) == ["E-stop", "M1 driver fault"]
    assert faults(0x0000_0041, FLAGS_32_BIT, 2) == ["E-stop"]
    assert faults(0x0003_0000, FLAGS_32_BIT, 1) == []  # warnings
    assert faults(0x0105, FLAGS_16_BIT, 1) == ["E-stop", "M1 driver fault"]
    assert faults(0x0001, FLAGS_16_BIT, 1) == []  # over-current warning; E-stop in the other layout


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("USB Roboclaw 2x15a v4.1.34", Identity("Basicmicro", "USB Roboclaw 2x15a", "4.1.34", simulated=False)),
        ("RoboClaw 10.2A v4.1.11", Identity("Basicmicro", "RoboClaw 10.2A", "4.1.11", simulated=False)),
        ("USB Roboclaw 2x7a v4.2.8 simulated", Identity("Basicmicro", "USB Roboclaw 2x7a", "4.2.8", simulated=True)),
        ("SDC2130 v1.8", None),
    ],
)
def test_who_answers(text, wanted):
    assert parse_version(text) == wanted
