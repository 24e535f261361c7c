"""ROBOTIS' own library drives the simulated servos: neither side of that conversation is our driver."""

import time

import pytest
from dynamixel_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    GroupSyncRead,
    GroupSyncWrite,
    PacketHandler,
    PortHandler,
    port_handler,
)

from tests.devices.device_process import device_process

port_handler.LATENCY_TIMER = 500.0  # ms, half of what it waits for an answer: with 16 a busy machine may be too late
TORQUE, MODE, GOAL_PWM, POSITION, ERROR, WATCHDOG = 64, 11, 100, 132, 70, 98
NO_ACCESS, OUT_OF_RANGE = 7, 4


class Host:
    """The library as its examples use it."""

    def __init__(self, path):
        self.port, self.packets = PortHandler(path), PacketHandler(2.0)
        assert self.port.openPort()
        # it polls without a pause: under `turns` that keeps the kernel from carrying what it waits for
        self.port.ser.timeout = 0.001

    def write1(self, servo, address, value):
        result, error = self.packets.write1ByteTxRx(self.port, servo, address, value)
        assert result == COMM_SUCCESS
        return error

    def write2(self, servo, address, value):
        result, error = self.packets.write2ByteTxRx(self.port, servo, address, value & 0xFFFF)
        assert result == COMM_SUCCESS
        return error

    def read4(self, servo, address):
        value, result, _ = self.packets.read4ByteTxRx(self.port, servo, address)
        assert result == COMM_SUCCESS
        return value

    def read1(self, servo, address):
        value, result, _ = self.packets.read1ByteTxRx(self.port, servo, address)
        assert result == COMM_SUCCESS
        return value


@pytest.fixture(scope="module")
def device():
    with device_process("dynamixel", "--joints", "2", "--baud", "0") as running:
        yield running


@pytest.fixture
def host(device):
    made = Host(device.port)
    yield made
    for servo in (1, 2):
        made.write1(servo, TORQUE, 0)
        made.write1(servo, WATCHDOG, 0)
    made.port.closePort()
    device.side.ask("repair")


def test_it_finds_them(host):
    found, result = host.packets.broadcastPing(host.port)
    assert result == COMM_SUCCESS
    assert {servo: model for servo, (model, _) in found.items()} == {1: 1020, 2: 1020}
    assert host.packets.ping(host.port, 1)[:2] == (1020, COMM_SUCCESS)
    assert host.packets.ping(host.port, 9)[1] == COMM_RX_TIMEOUT


def test_it_turns_them_with_one_packet_and_reads_both_with_one(host, device):
    turning = GroupSyncWrite(host.port, host.packets, GOAL_PWM, 2)
    for servo, duty in ((1, 150), (2, -150)):
        assert host.write1(servo, MODE, 16) == 0
        assert host.write2(servo, GOAL_PWM, 0) == 0
        assert host.write1(servo, TORQUE, 1) == 0
        assert turning.addParam(servo, [duty & 0xFF, duty >> 8 & 0xFF])
    before = {servo: host.read4(servo, POSITION) for servo in (1, 2)}
    assert turning.txPacket() == COMM_SUCCESS
    time.sleep(0.3)
    reading = GroupSyncRead(host.port, host.packets, POSITION, 4)
    for servo in (1, 2):
        reading.addParam(servo)
    assert reading.txRxPacket() == COMM_SUCCESS
    moved = {servo: (reading.getData(servo, POSITION, 4) - before[servo] + 2**31) % 2**32 - 2**31 for servo in (1, 2)}
    assert moved[1] > 100
    assert moved[2] < -100
    assert device.truth()["joint"]["rotor_rad"] > 0.0


def test_what_the_manual_refuses_is_refused(host):
    assert host.write1(1, TORQUE, 1) == 0
    assert host.write1(1, MODE, 16) == NO_ACCESS  # EEPROM area, while the torque is on
    host.write1(1, TORQUE, 0)
    assert host.write1(1, MODE, 16) == 0


def test_its_bus_watchdog_stops_it_and_refuses_goals_until_it_is_cleared(host, device):
    host.write1(1, MODE, 16)
    host.write1(1, WATCHDOG, 10)
    host.write1(1, TORQUE, 1)
    assert host.write2(1, GOAL_PWM, 100) == 0
    device.wait_for_power(True)
    device.wait_for_power(False)
    assert host.read1(1, WATCHDOG) == 255
    assert host.write2(1, GOAL_PWM, 100) == OUT_OF_RANGE
    assert host.write1(1, WATCHDOG, 0) == 0
    assert host.write2(1, GOAL_PWM, 0) == 0


def test_a_hardware_error_is_cleared_by_a_reboot_alone(host, device):
    host.write1(1, MODE, 16)
    host.write1(1, TORQUE, 1)
    device.side.ask("fault", name="over-temperature", duration_s=0.2)
    time.sleep(0.3)
    assert host.read1(1, ERROR) == 1 << 2
    assert host.read1(1, TORQUE) == 0
    _, error = host.packets.reboot(host.port, 1)
    assert error & 0x80  # the alert
    time.sleep(0.2)
    assert host.read1(1, ERROR) == 0
