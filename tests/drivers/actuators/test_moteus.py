"""What only a moteus controller does: its watchdog, several on one adapter, its library."""

import sys
import time

import pytest

from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError
from drivers.moteus.drive import MoteusDrive
from drivers.moteus.settings import MoteusSettings
from tests.drivers.actuators.kinds import JOINT, MOTEUS, PERIOD_S

pytestmark = pytest.mark.virtual_time
PUSH = Command(Mode.TORQUE, 0.015)


@pytest.fixture(scope="module")
def kind():
    return MOTEUS


def test_its_watchdog_takes_the_power_away_and_is_the_reason(device):
    """As delivered it would hold the speed at 0, with power."""
    drive = MOTEUS.drive_of(device, watchdog_s=0.4)
    drive.open(PERIOD_S)
    drive.enable(Mode.TORQUE)
    drive.exchange(PUSH)
    device.wait_for_power(True)
    device.wait_for_power(False)
    assert drive.inspect().fault.startswith("its watchdog has stopped it")
    drive.clear_fault()
    drive.enable(Mode.TORQUE)
    drive.close()


def test_two_on_one_adapter_are_asked_in_one_go(device):
    drives = [MOTEUS.drive_of(device, servo_id=servo) for servo in (1, 2)]
    for one in drives:
        one.open(PERIOD_S)
        one.enable(Mode.TORQUE)
    assert drives[0].bus is drives[1].bus
    for _ in range(10):
        time.sleep(PERIOD_S)
        samples = drives[0].exchange_together([(one, PUSH) for one in drives])
    assert [sample.status for sample in samples] == [Status.ENABLED] * 2
    assert all(sample.velocity_rad_s > 0.2 for sample in samples)
    for one in drives:
        one.close()


def test_without_its_library_the_next_step_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "drivers.moteus.actuator", None)
    with pytest.raises(DriveConfigurationError, match=r"pip install 'friction-bench\[moteus\]'"):
        MoteusDrive(MoteusSettings(port="port"), JOINT)
