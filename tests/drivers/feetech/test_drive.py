"""The Feetech driver: what the conformance tests, which know one servo alone, do not ask."""

import time

import pytest
from scservo_sdk import COMM_SUCCESS, PortHandler, sms_sts

from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveFault, WatchdogError
from drivers.feetech.drive import FeetechDrive
from drivers.feetech.settings import FeetechSettings
from drivers.joint import JointScale
from drivers.wraps import Turns
from tests.devices.device_process import device_process

pytestmark = pytest.mark.virtual_time
JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
OFF = Command(Mode.OFF)
PERIOD_S = 0.01
HIGHEST = 11  # in its memory


def drive_of(device, servo_id=1, **settings):
    values = {"answer_timeout_s": 0.2, "accept_no_watchdog": True} | settings
    return FeetechDrive(FeetechSettings(port=device.port, servo_id=servo_id, **values), JOINT)


@pytest.fixture(scope="module")
def running():
    with device_process("feetech", "--joints", "2", "--baud", "0") as made:
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


def test_nobody_runs_it_without_knowing_that_nothing_stops_it(device):
    with pytest.raises(WatchdogError, match="accept_no_watchdog = true"):
        drive_of(device, accept_no_watchdog=False).open(PERIOD_S)


def test_both_in_one_exchange(opened):
    drives = [opened(servo_id=servo_id) for servo_id in (1, 2)]
    starts_rad = [drive.exchange(OFF).position_rad for drive in drives]
    for drive in drives:
        drive.enable(Mode.DUTY)
    demands = [Command(Mode.DUTY, 0.2), Command(Mode.DUTY, -0.2)]
    for _ in range(25):
        time.sleep(PERIOD_S)
        samples = drives[0].exchange_together(list(zip(drives, demands, strict=True)))
    assert samples[0].position_rad - starts_rad[0] > 0.05
    assert samples[1].position_rad - starts_rad[1] < -0.05
    assert samples[0].duty == pytest.approx(0.2, abs=0.002)
    assert samples[1].duty == pytest.approx(-0.2, abs=0.002)


def test_a_torque_limit_bounds_the_duty(opened):
    drive = opened(torque_limit=0.1)
    drive.enable(Mode.DUTY)
    for _ in range(5):
        time.sleep(PERIOD_S)
        last = drive.exchange(Command(Mode.DUTY, 0.3))
    assert last.duty == pytest.approx(0.1, abs=0.002)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("supply-lost", "voltage error"),
        ("over-temperature", "overheating error"),
        ("over-current", "over-current error"),
        ("drive-failed", "overload error"),
    ],
)
def test_a_fault_is_named_and_the_power_is_off(opened, device, name, reason):
    drive = opened()
    drive.enable(Mode.DUTY)
    device.side.ask("fault", name=name)
    time.sleep(0.02)
    assert drive.exchange(Command(Mode.DUTY, 0.1)).status is Status.FAULT
    with pytest.raises(DriveFault, match=reason):
        drive.exchange(Command(Mode.DUTY, 0.1))
    device.wait_for_power(False)
    device.side.ask("repair")
    time.sleep(0.02)
    drive.clear_fault()
    drive.enable(Mode.DUTY)
    assert drive.exchange(Command(Mode.DUTY, 0.0)).status is Status.ENABLED


def test_two_servos_of_one_id_are_told_apart_from_silence():
    with device_process("feetech", "--twins", "--baud", "0") as device:
        with pytest.raises(DriveConnectionError, match="two servos of one id"):
            drive_of(device).open(PERIOD_S)
        assert not device.truth()["powered"]


def test_a_position_beyond_its_one_turn_is_refused(opened):
    drive = opened()
    drive.enable(Mode.POSITION)
    with pytest.raises(DriveConfigurationError, match="knows one turn"):
        drive.exchange(Command(Mode.POSITION, 2.0))


def test_a_position_beyond_the_servos_own_limits_is_refused():
    with device_process("feetech", "--baud", "0") as device:
        port = PortHandler(device.port)
        assert port.openPort()
        assert sms_sts(port).write2ByteTxRx(1, HIGHEST, 300) == (COMM_SUCCESS, 0)
        port.closePort()
        drive = drive_of(device)
        drive.open(PERIOD_S)
        drive.enable(Mode.POSITION)
        with pytest.raises(DriveConfigurationError, match=r"this one 0 \.\. 300 of it"):
            drive.exchange(Command(Mode.POSITION, 0.1))
        drive.close()


def test_a_count_is_followed_over_turns_by_the_speed():
    turns, counts_s = Turns(4096), 60_000.0  # 0.6 turns in 10 ms and 41 ms: more than half a turn each
    times_s = [0.0, 0.01, 0.02, 0.061, 0.071]
    found = [turns.follow(round(counts_s * time_s) % 4096, counts_s, time_s) for time_s in times_s]
    assert found == [round(counts_s * time_s) for time_s in times_s]
