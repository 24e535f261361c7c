"""The Damiao driver: what the conformance tests do not ask."""

import time
from math import isnan

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode, Status
from drivers.damiao.drive import DamiaoDrive
from drivers.damiao.settings import DamiaoSettings
from drivers.errors import DriveConfigurationError, DriveFault
from drivers.joint import JointScale
from tests.devices.device_process import device_process

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
OFF = Command(Mode.OFF)
PERIOD_S = 0.01


def drive_of(device, **settings):
    values = {"answer_timeout_s": 0.2, "watchdog_s": 1.0} | settings
    return DamiaoDrive(DamiaoSettings(BusSettings("slcan", device.drive["channel"]), **values), JOINT)


@pytest.fixture(scope="module")
def running():
    with device_process("damiao") as made:
        yield made


@pytest.fixture
def device(running):
    yield running
    running.side.ask("repair")
    running.wait_for_power(False)
    running.side.hang_load(0.0, False)


@pytest.fixture
def drive(device):
    made = drive_of(device)
    made.open(PERIOD_S)
    yield made
    made.close()


def test_ranges_are_checked_before_motion(device):
    with pytest.raises(DriveConfigurationError, match=r"a DM4310 has 12.5 rad, 30 rad/s, 10 N m"):
        drive_of(device, model="DM4310").open(PERIOD_S)
    assert not device.truth()["powered"]


def test_a_torque_beyond_its_frame_is_refused(drive):
    drive.enable(Mode.TORQUE)
    with pytest.raises(DriveConfigurationError, match=r"-0.5 .. 0.5 N m"):
        drive.exchange(Command(Mode.TORQUE, 0.6))


def test_torque_is_measured_and_current_is_not(drive):
    drive.enable(Mode.TORQUE)
    for _ in range(10):
        time.sleep(PERIOD_S)
        last = drive.exchange(Command(Mode.TORQUE, 0.015))
    drive.disable()
    assert last.torque_n_m == pytest.approx(0.015, abs=0.002)
    assert isnan(last.current_a)


def test_a_quick_stop_damps(drive, device):
    drive.enable(Mode.TORQUE)
    for _ in range(20):
        time.sleep(PERIOD_S)
        moving = drive.exchange(Command(Mode.TORQUE, 0.02))
    drive.quick_stop()
    torques = [drive.exchange(OFF).torque_n_m for _ in range(3) if not time.sleep(PERIOD_S)]
    assert moving.velocity_rad_s > 0.5
    assert min(torques) < -0.002  # against the motion
    for _ in range(120):
        time.sleep(PERIOD_S)
        last = drive.exchange(OFF)
    assert last.status is Status.DISABLED
    device.wait_for_power(False)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("supply-lost", "under-voltage"),
        ("over-temperature", "motor over-temperature"),
        ("over-current", "over-current"),
        ("drive-failed", "overload"),
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
    device.side.ask("repair")
    drive.clear_fault()
    drive.enable(Mode.TORQUE)
    assert drive.exchange(Command(Mode.TORQUE, 0.0)).status is Status.ENABLED


def turn_on_and_on(drive):
    for _ in range(200):
        time.sleep(PERIOD_S)
        drive.exchange(Command(Mode.TORQUE, 0.015))


def test_an_end_of_its_range_of_positions_is_a_fault():
    with device_process("damiao", "--position-range", "2") as device:
        drive = drive_of(device)
        drive.open(PERIOD_S)
        drive.enable(Mode.TORQUE)
        with pytest.raises(DriveFault, match="end of the range"):
            turn_on_and_on(drive)
        device.wait_for_power(False)
        drive.close()
