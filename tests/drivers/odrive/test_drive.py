"""The ODrive driver: what the conformance tests, which know one axis alone, do not ask."""

import time

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveFault, WatchdogError
from drivers.joint import JointScale
from drivers.odrive.drive import OdriveDrive
from drivers.odrive.settings import OdriveSettings
from tests.devices.device_process import device_process

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
OFF = Command(Mode.OFF)
PERIOD_S = 0.01


def drive_of(device, **settings):
    values = {"answer_timeout_s": 0.2, "watchdog_s": 1.0, "watchdog_is_set_in_drive": True} | settings
    return OdriveDrive(OdriveSettings(BusSettings("slcan", device.drive["channel"]), **values), JOINT)


@pytest.fixture(scope="module")
def running():
    with device_process("odrive", "--watchdog", "1.0") as made:
        yield made


@pytest.fixture
def device(running):
    yield running
    running.side.ask("repair")
    running.wait_for_power(False)


@pytest.fixture
def drive(device):
    made = drive_of(device)
    made.open(PERIOD_S)
    yield made
    made.close()


def test_a_watchdog_that_nobody_vouches_for_is_refused(device):
    with pytest.raises(WatchdogError, match=r"enable_watchdog = True"):
        drive_of(device, watchdog_is_set_in_drive=False).open(PERIOD_S)


def test_an_interface_without_remote_frames_is_refused(device):
    drive = OdriveDrive(OdriveSettings(BusSettings("socketcand", "can0")), JOINT)
    with pytest.raises(DriveConfigurationError, match="no remote frames"):
        drive.open(PERIOD_S)


def test_a_torque_is_the_current_times_the_torque_constant(drive):
    drive.enable(Mode.TORQUE)
    for _ in range(10):
        time.sleep(PERIOD_S)
        last = drive.exchange(Command(Mode.TORQUE, 0.015))
    drive.disable()
    assert last.current_a == pytest.approx(0.015 / 0.05, rel=0.05)  # N m/A of the preset `paper`


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("supply-lost", "DC bus under-voltage"),
        ("over-temperature", "motor over-temperature"),
        ("over-current", "current limit violation"),
        ("drive-failed", "driver fault"),
        ("torque-disabled", "e-stop requested"),
    ],
)
def test_a_fault_is_named_and_the_power_is_off(drive, device, name, reason):
    drive.enable(Mode.TORQUE)
    device.side.ask("fault", name=name)
    time.sleep(0.02)
    assert drive.exchange(Command(Mode.TORQUE, 0.002)).status is Status.FAULT
    with pytest.raises(DriveFault, match=reason):
        drive.exchange(Command(Mode.TORQUE, 0.002))
    device.wait_for_power(False)
    with pytest.raises(DriveFault, match="cannot be cleared"):
        drive.clear_fault()
    device.side.ask("repair")
    time.sleep(0.02)
    drive.clear_fault()
    drive.enable(Mode.TORQUE)
    assert drive.exchange(Command(Mode.TORQUE, 0.0)).status is Status.ENABLED
