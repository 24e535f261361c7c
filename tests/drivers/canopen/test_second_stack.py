"""The driver on a drive whose CANopen stack is not ours: what two of ours have both misread shows here."""

import time

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status, Watchdog
from drivers.joint import JointScale
from tests.drivers.canopen.durand_drive import DurandDrive

PERIOD_S, WATCHDOG_S = 0.01, 0.4
OFF, PUSH = Command(Mode.OFF), Command(Mode.CURRENT, 0.3)


@pytest.fixture
def device(request):
    with DurandDrive(request.node.name) as running:
        yield running


@pytest.fixture
def drive(device, request):
    settings = CanopenSettings(
        bus=BusSettings("virtual", request.node.name), node_id=5, watchdog_s=WATCHDOG_S, answer_s=0.3, listen_s=0.05,
        velocity_unit="counts/s",
    )  # fmt: skip
    made = CanopenDrive(settings, JointScale(4096, 20.0))
    made.open(PERIOD_S)
    yield made
    made.close()


def cycles(drive, command, count):
    for _ in range(count):
        time.sleep(PERIOD_S)
        sample = drive.exchange(command)
    return sample


def test_it_opens_and_says_what_it_has(drive):
    found = drive.describe()
    assert found.modes == {Mode.CURRENT}
    assert {"position_rad", "velocity_rad_s", "current_a", "supply_v"} <= found.measured
    assert found.watchdog is Watchdog.CONFIGURED
    assert drive.watchdog == "heartbeat consumer 0x1016, 0.4 s; then fault (0x6007 = 1)"


def test_it_moves_as_it_is_told_and_is_seen_where_it_is(drive, device):
    start_rad = drive.exchange(OFF).position_rad
    drive.enable(Mode.CURRENT)
    sample = cycles(drive, PUSH, 30)
    assert sample.status is Status.ENABLED
    assert sample.current_a == pytest.approx(0.3, abs=2e-3)
    assert sample.velocity_rad_s > 0.5
    assert sample.position_rad - start_rad > 0.05
    drive.disable()
    cycles(drive, OFF, 60)
    assert cycles(drive, OFF, 3).position_rad == pytest.approx(device.axis.seen.position_rad, abs=1e-3)
    assert not device.axis.power.on


def test_it_stops_when_the_host_is_silent_and_is_cleared(drive, device):
    drive.enable(Mode.CURRENT)
    cycles(drive, PUSH, 5)
    time.sleep(1.5 * WATCHDOG_S)
    found = drive.inspect()
    assert (found.status, found.fault[:6]) == (Status.FAULT, "0x8130")
    assert not device.axis.power.on
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    assert cycles(drive, PUSH, 3).status is Status.ENABLED


def test_no_cycle_is_lost(drive):
    cycles(drive, OFF, 100)
    assert drive.counts.missed == drive.counts.surplus == 0
