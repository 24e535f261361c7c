"""Feetech's own library and the simulated servos; and its packets beside those of the driver."""

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scservo_sdk import COMM_RX_TIMEOUT, COMM_SUCCESS, GroupSyncRead, PortHandler, protocol_packet_handler, sms_sts

from drivers.feetech import frames
from drivers.servos.frames import StatusPacket
from sim_backend.devices.feetech import packets
from tests.devices.device_process import device_process

TORQUE, MODE, GOAL_TIME, PIECE = 40, 33, 44, 56
RESPONSE_LEVEL, LOWEST, HIGHEST = 8, 9, 11
BACKWARD = 1 << 10


class Wire:
    """The port of Feetech's library, with what it has sent."""

    is_using, sent = False, b""

    def clearPort(self):  # noqa: N802
        """Nothing waits."""

    def writePort(self, packet):  # noqa: N802
        self.sent = bytes(packet)
        return len(packet)


def asked(question, servo):
    """The answer. Asked again, as the library waits for 17 ms only: on a busy machine it may take longer."""
    end_s = time.monotonic() + 2.0
    while True:
        value, result, _ = question(servo)
        if result != COMM_RX_TIMEOUT or time.monotonic() > end_s:
            assert result == COMM_SUCCESS
            return value


@given(st.integers(0, 253), st.integers(0, 100), st.binary(min_size=1, max_size=20))
def test_packets_are_those_of_the_makers_library(servo, address, data):
    wire = Wire()
    protocol_packet_handler(wire, 0).writeTxOnly(servo, address, len(data), list(data))
    assert frames.write_packet(servo, address, data) == wire.sent
    [heard] = packets.InstructionReader().feed(b"\xff\x00\xff" + wire.sent, 0.0)
    assert heard == packets.Instruction(servo, 3, bytes((address,)) + data)


@given(st.lists(st.integers(0, 253), min_size=1, max_size=8, unique=True))
def test_questions_to_several_are_those_of_the_makers_library(servos):
    wire = Wire()
    protocol_packet_handler(wire, 0).syncReadTx(PIECE, 15, servos, len(servos))
    assert frames.sync_read_packet(tuple(servos), PIECE, 15) == wire.sent


@given(st.integers(0, 253), st.integers(0, 63), st.binary(max_size=20))
def test_answers_are_understood(servo, error, data):
    answer = packets.status(servo, error, data)
    assert frames.packet_bytes(answer) == len(answer)
    assert frames.status(answer) == StatusPacket(servo, error, data)
    spoilt = bytearray(answer)
    spoilt[-2] ^= 1
    assert frames.status(bytes(spoilt)) is None


@given(st.integers(-1023, 1023))
def test_signs_are_a_bit_of_their_own(value):
    handler = protocol_packet_handler(Wire(), 0)
    assert frames.with_sign(value, 10) == handler.scs_toscs(value, 10)
    assert frames.signed(frames.with_sign(value, 10), 10) == value


@pytest.fixture(scope="module")
def device():
    with device_process("feetech", "--joints", "2", "--baud", "0") as running:
        yield running


@pytest.fixture
def host(device):
    port = PortHandler(device.port)
    assert port.openPort()
    # it polls without a pause: under `turns` that keeps the kernel from carrying what it waits for
    port.ser.timeout = 0.001
    made = sms_sts(port)
    yield made
    for servo in (1, 2):
        made.write1ByteTxRx(servo, TORQUE, 0)
    port.closePort()


def test_it_finds_them(host):
    assert host.ping(1)[:2] == (777, COMM_SUCCESS)
    assert host.ping(9)[1] != COMM_SUCCESS


def test_it_turns_one_in_open_loop_and_reads_both_with_one_packet(host, device):
    assert host.write1ByteTxRx(1, MODE, 2) == (COMM_SUCCESS, 0)
    assert host.write2ByteTxRx(1, GOAL_TIME, BACKWARD | 200) == (COMM_SUCCESS, 0)
    before = asked(host.ReadPos, 1), asked(host.ReadPos, 2)
    assert host.write1ByteTxRx(1, TORQUE, 1) == (COMM_SUCCESS, 0)
    time.sleep(0.2)
    assert asked(host.ReadSpeed, 1) < 0
    reading = GroupSyncRead(host, PIECE, 6)
    for servo in (1, 2):
        reading.addParam(servo)
    assert reading.txRxPacket() == COMM_SUCCESS
    assert reading.getData(1, 60, 2) & BACKWARD  # the load has the sign of the duty
    assert reading.getData(2, 56, 2) == before[1]
    assert reading.getData(1, 56, 2) != before[0]
    assert device.truth()["joint"]["rotor_rad"] < 0.0


def test_it_goes_to_a_position(host):
    assert host.write1ByteTxRx(2, MODE, 0) == (COMM_SUCCESS, 0)
    here = asked(host.ReadPos, 2)
    assert host.write1ByteTxRx(2, TORQUE, 1) == (COMM_SUCCESS, 0)
    host.WritePosEx(2, here + 500, 0, 0)
    time.sleep(0.5)
    assert asked(host.ReadPos, 2) == pytest.approx(here + 500, abs=120)  # friction holds it before it is there


def test_it_is_as_delivered_and_keeps_within_its_limits(host):
    assert asked(lambda servo: host.read2ByteTxRx(servo, LOWEST), 2) == 0
    assert asked(lambda servo: host.read2ByteTxRx(servo, HIGHEST), 2) == 4095
    assert asked(lambda servo: host.read1ByteTxRx(servo, RESPONSE_LEVEL), 2) == 1
    here = asked(host.ReadPos, 2)
    assert host.write2ByteTxRx(2, HIGHEST, here + 300) == (COMM_SUCCESS, 0)
    assert host.write1ByteTxRx(2, TORQUE, 1) == (COMM_SUCCESS, 0)
    host.WritePosEx(2, here + 900, 0, 0)
    time.sleep(0.5)
    assert asked(host.ReadPos, 2) == pytest.approx(here + 300, abs=120)
