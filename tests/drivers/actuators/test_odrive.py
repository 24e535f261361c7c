"""What only an ODrive axis does: its watchdog is vouched for, and it is asked by remote frames."""

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveFault, WatchdogError
from tests.drivers.actuators.kinds import ODRIVE, PERIOD_S

pytestmark = pytest.mark.virtual_time


@pytest.fixture(scope="module")
def kind():
    return ODRIVE


def test_a_watchdog_that_nobody_vouches_for_is_refused(device):
    with pytest.raises(WatchdogError, match=r"enable_watchdog = True"):
        ODRIVE.drive_of(device, watchdog_is_set_in_drive=False).open(PERIOD_S)


def test_an_interface_without_remote_frames_is_refused():
    with pytest.raises(DriveConfigurationError, match="no remote frames"):
        ODRIVE.on(BusSettings("socketcand", "can0")).open(PERIOD_S)


def test_a_fault_whose_cause_is_there_is_not_cleared(drive, device):
    drive.enable(Mode.TORQUE)
    device.side.ask("fault", name="supply-lost")
    device.wait_for_power(False)
    assert drive.exchange(Command(Mode.TORQUE, 0.002)).status is Status.FAULT
    with pytest.raises(DriveFault, match="cannot be cleared"):
        drive.clear_fault()
