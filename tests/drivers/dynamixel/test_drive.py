"""The driver on simulated servos: what the conformance tests, which know one servo alone, do not ask."""

import time
from math import isnan

import pytest

from drivers.contract import Command, Mode, Status
from drivers.dynamixel.drive import DynamixelDrive
from drivers.dynamixel.settings import DynamixelSettings
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveFault
from drivers.joint import JointScale
from tests.devices.device_process import device_process

pytestmark = pytest.mark.virtual_time
JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
OFF = Command(Mode.OFF)
PERIOD_S = 0.01


def drive_of(device, servo_id=1, joint=JOINT, **settings):
    values = {"answer_timeout_s": 0.2, "watchdog_s": 1.0} | settings
    return DynamixelDrive(DynamixelSettings(port=device.port, servo_id=servo_id, **values), joint)


@pytest.fixture(scope="module")
def running():
    with device_process("dynamixel", "--joints", "3", "--baud", "0") as made:
        yield made


@pytest.fixture
def device(running):
    yield running
    running.side.ask("repair")
    running.wait_for_power(False)


@pytest.fixture
def opened(device):
    made = []

    def open_one(**values):
        made.append(drive_of(device, **values))
        made[-1].open(PERIOD_S)
        return made[-1]

    yield open_one
    for drive in made:
        drive.close()


def test_several_joints_on_one_line_in_one_exchange(opened):
    drives = [opened(servo_id=servo_id) for servo_id in (1, 2, 3)]
    assert drives[0].bus is not None
    assert all(drive.bus is drives[0].bus for drive in drives)
    starts_rad = [drive.exchange(OFF).position_rad for drive in drives]
    for drive in drives:
        drive.enable(Mode.DUTY)
    demands = [Command(Mode.DUTY, 0.2), Command(Mode.DUTY, -0.2), Command(Mode.DUTY, 0.0)]
    for _ in range(25):
        time.sleep(PERIOD_S)
        samples = drives[0].exchange_together(list(zip(drives, demands, strict=True)))
    moved_rad = [sample.position_rad - start for sample, start in zip(samples, starts_rad, strict=True)]
    assert moved_rad[0] > 0.05
    assert moved_rad[1] < -0.05
    assert abs(moved_rad[2]) < 0.01
    assert {sample.status for sample in samples} == {Status.ENABLED}
    assert len({sample.time_s for sample in samples}) == 1, "not one exchange"


def test_one_that_is_gone_takes_the_power_from_all(opened, device):
    drives = [opened(servo_id=servo_id) for servo_id in (1, 2)]
    for drive in drives:
        drive.enable(Mode.DUTY)
    device.side.ask("link", name="drop", direction="from-device")
    with pytest.raises(DriveConnectionError, match="id 1, 2"):
        drives[0].exchange_together([(drive, Command(Mode.DUTY, 0.1)) for drive in drives])
    device.wait_for_power(False)


def test_the_line_stays_open_until_the_last_servo_is_closed(opened):
    first, second = opened(servo_id=1), opened(servo_id=2)
    first.close()
    assert second.exchange(OFF).status is Status.DISABLED


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("supply-lost", "input voltage error"),
        ("over-temperature", "overheating error"),
        ("over-current", "overload error"),
        ("drive-failed", "electrical shock error"),
    ],
)
def test_a_fault_is_named_and_the_power_is_off(opened, device, name, reason):
    drive = opened()
    drive.enable(Mode.CURRENT)
    device.side.ask("fault", name=name)
    time.sleep(0.02)
    assert drive.exchange(Command(Mode.CURRENT, 0.1)).status is Status.FAULT
    with pytest.raises(DriveFault, match=reason):
        drive.exchange(Command(Mode.CURRENT, 0.1))
    assert drive.inspect().fault == reason
    device.wait_for_power(False)
    with pytest.raises(DriveFault, match="cannot be cleared"):
        drive.clear_fault()
    device.side.ask("repair")
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    assert drive.exchange(Command(Mode.CURRENT, 0.0)).status is Status.ENABLED


def test_two_servos_of_one_id_are_told_apart_from_silence():
    with device_process("dynamixel", "--twins", "--baud", "0") as device:
        drive = drive_of(device)
        with pytest.raises(DriveConnectionError, match="two servos of one id"):
            drive.open(PERIOD_S)
        assert not device.truth()["powered"]


def test_a_rig_that_counts_otherwise_is_refused(device):
    refusal = pytest.raises(DriveConfigurationError, match=r"are 4096 at its output; the rig says 1024")
    with refusal:
        drive_of(device, joint=JointScale(1024, 20.0)).open(PERIOD_S)


def test_a_current_limit_is_set_in_the_servo(opened):
    drive = opened(current_limit_a=0.2)
    drive.enable(Mode.POSITION)
    here_rad = drive.exchange(OFF).position_rad
    drive.enable(Mode.POSITION)
    currents_a = []
    for _ in range(20):
        time.sleep(PERIOD_S)
        currents_a.append(abs(drive.exchange(Command(Mode.POSITION, here_rad + 1.0)).current_a))
    drive.disable()
    opened(servo_id=1, current_limit_a=3.0)  # puts it back
    assert 0.1 < max(currents_a) < 0.22


def test_a_model_without_a_current_sensor_says_so():
    with device_process("dynamixel", "--model", "XL430-W250", "--baud", "0") as device:
        drive = drive_of(device)
        drive.open(PERIOD_S)
        found = drive.describe()
        assert Mode.CURRENT not in found.modes
        assert "current_a" not in found.measured
        assert any("measures no current" in note for note in found.notes)
        assert isnan(drive.exchange(OFF).current_a)
        with pytest.raises(DriveConfigurationError, match="no mode 'current'"):
            drive.enable(Mode.CURRENT)
        drive.close()


def test_a_model_whose_indirect_data_have_moved(device):
    with device_process("dynamixel", "--model", "XL330-M288", "--baud", "0") as other:
        drive = drive_of(other)
        drive.open(PERIOD_S)
        assert drive.exchange(OFF).supply_v == pytest.approx(24.0, abs=0.2)
        drive.close()


def test_a_quick_stop_of_a_position_ends_in_power_off(opened, device):
    drive = opened()
    drive.enable(Mode.POSITION)
    here_rad = drive.exchange(OFF).position_rad
    drive.enable(Mode.POSITION)
    drive.exchange(Command(Mode.POSITION, here_rad + 0.1))
    drive.quick_stop()
    for _ in range(120):
        time.sleep(PERIOD_S)
        last = drive.exchange(OFF)
    assert last.status is Status.DISABLED
    device.wait_for_power(False)
