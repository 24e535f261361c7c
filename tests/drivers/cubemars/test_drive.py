"""The CubeMars driver: what the conformance tests do not ask."""

import time
from math import isnan

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode, Status
from drivers.cubemars.drive import CubemarsDrive
from drivers.cubemars.settings import CubemarsSettings
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveFault, WatchdogError
from drivers.joint import JointScale
from sim_backend.devices.cubemars.serve import CubemarsSimulation, serve_cubemars
from tests.devices.device_process import device_process

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
RANGES = {"position_range_rad": 100.0, "speed_range_rad_s": 200.0, "torque_range_n_m": 0.5}
OFF = Command(Mode.OFF)
PERIOD_S = 0.01


def drive_of(device, **settings):
    values = {"answer_timeout_s": 0.2, "accept_no_watchdog": True, **RANGES} | settings
    return CubemarsDrive(CubemarsSettings(BusSettings("slcan", device.drive["channel"]), **values), JOINT)


@pytest.fixture(scope="module")
def running():
    with device_process("cubemars") as made:
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


def test_nobody_runs_it_unknowingly(device):
    with pytest.raises(WatchdogError, match="accept_no_watchdog = true"):
        drive_of(device, accept_no_watchdog=False).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_ranges_that_are_not_known_are_refused_before_anything_is_sent(device):
    with pytest.raises(DriveConfigurationError, match="a wrong range is a wrong torque"):
        drive_of(device, torque_range_n_m=0.0).open(PERIOD_S)
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
    assert 15.0 < last.temperature_c < 45.0


def test_what_it_is_told_last_is_no_torque():
    """It keeps that, and begins with it where it is enabled again."""
    ranges = 100.0, 200.0, 0.5
    with serve_cubemars(CubemarsSimulation(interface="virtual", channel="cubemars-last", ranges=ranges)) as served:
        bus = BusSettings("virtual", "cubemars-last")
        drive = CubemarsDrive(CubemarsSettings(bus, accept_no_watchdog=True, answer_timeout_s=0.2, **RANGES), JOINT)
        drive.open(PERIOD_S)
        drive.enable(Mode.TORQUE)
        drive.exchange(Command(Mode.TORQUE, 0.02))
        assert served.device.command.torque_n_m == pytest.approx(0.02, abs=1e-3)
        drive.disable()
        assert served.device.command.torque_n_m == pytest.approx(0.0, abs=2e-4)
        assert not served.device.is_on
        drive.close()


@pytest.mark.parametrize(
    ("name", "reason"),
    [("supply-lost", "under-voltage"), ("over-temperature", "over-temperature"), ("over-current", "over-current")],
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


def test_answers_of_another_identifier_are_not_taken(device):
    with pytest.raises(DriveConnectionError, match=r"feedback_id \(0\)"):
        drive_of(device, feedback_id=0, answer_timeout_s=0.02).open(PERIOD_S)
