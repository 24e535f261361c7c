"""The moteus driver: what the conformance tests do not ask."""

import sys
import time

import pytest

from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveFault
from drivers.joint import JointScale
from drivers.moteus.drive import MoteusDrive
from drivers.moteus.settings import MoteusSettings
from tests.devices.device_process import device_process

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
PERIOD_S = 0.01
PUSH = Command(Mode.TORQUE, 0.015)


def drive_of(device, **settings):
    values = {"answer_timeout_s": 0.2, "watchdog_s": 1.0} | settings
    return MoteusDrive(MoteusSettings(device.port, **values), JOINT)


@pytest.fixture(scope="module")
def running():
    with device_process("moteus", "--joints", "2") as made:
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


def test_it_says_who_it_is(drive):
    found = drive.describe()
    assert (found.vendor, found.firmware, found.simulated) == ("mjbots", "1.11.0", True)


def test_torque_current_supply_and_temperature_are_measured(drive):
    drive.enable(Mode.TORQUE)
    for _ in range(10):
        time.sleep(PERIOD_S)
        last = drive.exchange(PUSH)
    drive.disable()
    assert last.torque_n_m == pytest.approx(0.015, abs=0.002)
    assert last.current_a == pytest.approx(0.3, abs=0.04)
    assert last.supply_v == pytest.approx(24.0, abs=0.2)
    assert 15.0 < last.temperature_c < 45.0


def test_its_watchdog_takes_the_power_away_and_is_the_reason(drive, device):
    """As delivered it would hold the speed at 0, with power."""
    made = drive_of(device, watchdog_s=0.4)
    drive.close()
    made.open(PERIOD_S)
    made.enable(Mode.TORQUE)
    made.exchange(PUSH)
    device.wait_for_power(True)
    device.wait_for_power(False)
    assert made.inspect().fault.startswith("its watchdog has stopped it")
    made.clear_fault()
    made.enable(Mode.TORQUE)
    made.close()


def test_two_on_one_adapter_are_asked_in_one_go(device):
    drives = [drive_of(device, servo_id=servo) for servo in (1, 2)]
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


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("supply-lost", "under-voltage"),
        ("over-temperature", "over-temperature"),
        ("over-current", "motor driver fault"),
    ],
)
def test_a_fault_is_named_and_the_power_is_off(drive, device, name, reason):
    drive.enable(Mode.TORQUE)
    device.side.ask("fault", name=name)
    time.sleep(0.02)
    assert drive.exchange(PUSH).status is Status.FAULT
    with pytest.raises(DriveFault, match=reason):
        drive.exchange(PUSH)
    device.wait_for_power(False)
    device.side.ask("repair")
    drive.clear_fault()
    drive.enable(Mode.TORQUE)
    assert drive.exchange(Command(Mode.TORQUE, 0.0)).status is Status.ENABLED


def test_a_quick_stop_brakes_and_ends_in_power_off(drive, device):
    drive.enable(Mode.TORQUE)
    for _ in range(20):
        time.sleep(PERIOD_S)
        moving = drive.exchange(PUSH)
    drive.quick_stop()
    assert moving.velocity_rad_s > 0.5
    for _ in range(120):
        time.sleep(PERIOD_S)
        last = drive.exchange(Command(Mode.OFF))
    assert last.status is Status.DISABLED
    assert device.truth()["stage"] == "open"


def test_without_its_library_the_next_step_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "drivers.moteus.actuator", None)
    with pytest.raises(DriveConfigurationError, match=r"pip install 'friction-bench\[moteus\]'"):
        MoteusDrive(MoteusSettings("port"), JOINT)
