"""The RobStride driver: what the conformance tests do not ask."""

import time

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveFault
from drivers.joint import JointScale
from drivers.robstride.drive import RobstrideDrive
from drivers.robstride.settings import RobstrideSettings
from tests.devices.device_process import device_process

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
RANGES = {"position_range_rad": 100.0, "speed_range_rad_s": 200.0, "torque_range_n_m": 0.5}
OFF = Command(Mode.OFF)
PERIOD_S = 0.01


def drive_of(device, **settings):
    values = {"answer_timeout_s": 0.2, "watchdog_s": 1.0, **RANGES} | settings
    return RobstrideDrive(RobstrideSettings(BusSettings("slcan", device.drive["channel"]), **values), JOINT)


@pytest.fixture(scope="module")
def running():
    with device_process("robstride") as made:
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


def test_a_torque_limit_beyond_the_range_is_another_model(device):
    with pytest.raises(DriveConfigurationError, match=r"torque limit is 0.5 N m, and its frames would end at 0.4 N m"):
        drive_of(device, torque_range_n_m=0.4).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_a_range_of_positions_that_is_not_its_own_is_seen_before_motion(device):
    device.side.ask("hold", angle_rad=0.3)
    device.side.ask("release")
    with pytest.raises(DriveConfigurationError, match="its firmware has another range"):
        drive_of(device, position_range_rad=50.0).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_it_says_who_it_is(drive):
    found = drive.describe()
    assert (found.firmware, found.simulated) == ("0.4.2.6", True)
    assert found.serial == "5349 4d55 4c41 5445"


def test_torque_supply_and_temperature_are_measured(drive):
    drive.enable(Mode.TORQUE)
    for _ in range(40):
        time.sleep(PERIOD_S)
        last = drive.exchange(Command(Mode.TORQUE, 0.015))
    drive.disable()
    assert last.torque_n_m == pytest.approx(0.015, abs=0.002)
    assert last.supply_v == pytest.approx(24.0, abs=0.2)
    assert 15.0 < last.temperature_c < 45.0
    assert last.ages.supply_s < 0.6


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
        ("over-temperature", "over-temperature"),
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
