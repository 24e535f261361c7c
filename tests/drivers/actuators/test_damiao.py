"""What only a Damiao actuator does: it says its ranges."""

import time

import pytest

from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError, DriveFault
from tests.devices.device_process import device_process
from tests.drivers.actuators.kinds import DAMIAO, PERIOD_S

pytestmark = pytest.mark.virtual_time


@pytest.fixture(scope="module")
def kind():
    return DAMIAO


def test_ranges_are_checked_before_motion(device):
    with pytest.raises(DriveConfigurationError, match=r"a DM4310 has 12.5 rad, 30 rad/s, 10 N m"):
        DAMIAO.drive_of(device, model="DM4310").open(PERIOD_S)
    assert not device.truth()["powered"]


def turn_on_and_on(drive):
    for _ in range(200):
        time.sleep(PERIOD_S)
        drive.exchange(Command(Mode.TORQUE, 0.015))


def test_an_end_of_its_range_of_positions_is_a_fault():
    with device_process("damiao", "--position-range", "2") as device:
        drive = DAMIAO.drive_of(device)
        drive.open(PERIOD_S)
        drive.enable(Mode.TORQUE)
        with pytest.raises(DriveFault, match="end of the range"):
            turn_on_and_on(drive)
        device.wait_for_power(False)
        drive.close()
