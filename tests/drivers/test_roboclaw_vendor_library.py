"""Basicmicro's own library turns the simulated RoboClaw. Neither side of that conversation is our driver."""

import time

import pytest
from basicmicro import Basicmicro

from tests.devices.device_process import device_process

ADDRESS = 0x80
FULL = 32767


@pytest.fixture
def device():
    with device_process("roboclaw", "--baud", "0") as made:
        yield made


@pytest.fixture
def library(device):
    # it asks three times where a busy machine lets an answer wait for more than 10 ms
    made = Basicmicro(device.port, 115200, timeout=0.5)
    assert made.Open()
    yield made
    made.close()


def test_it_is_taken_for_one_of_basicmicros(library):
    is_there, version = library.ReadVersion(ADDRESS)
    assert is_there
    assert version.startswith("USB Roboclaw 2x15a")


def test_it_turns_and_tells_what_it_measures(library, device):
    assert library.SetTimeout(ADDRESS, 1.0)
    assert library.GetTimeout(ADDRESS) == (True, pytest.approx(1.0))
    assert library.ReadMainBatteryVoltage(ADDRESS) == (True, pytest.approx(240, abs=2))
    assert library.ReadTemp(ADDRESS)[1] == pytest.approx(300, abs=150)
    before = library.ReadEncM1(ADDRESS)[1]
    assert library.DutyM1(ADDRESS, round(0.2 * FULL))
    for _ in range(20):
        time.sleep(0.01)
        is_told, count, _ = library.ReadEncM1(ADDRESS)
        assert is_told
    assert count - before > 200
    assert library.ReadSpeedM1(ADDRESS)[1] > 1000
    assert library.ReadPWMs(ADDRESS)[:2] == (True, pytest.approx(0.2 * FULL, abs=40))
    assert library.ReadCurrents(ADDRESS)[1] > 0
    assert library.DutyM1(ADDRESS, 0)
    device.wait_for_power(False)


def test_its_silence_stops_the_motor(library, device):
    assert library.SetTimeout(ADDRESS, 0.5)
    assert library.DutyM1(ADDRESS, round(0.2 * FULL))
    device.wait_for_power(True)
    device.wait_for_power(False)
