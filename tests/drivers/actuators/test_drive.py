"""Every kind of actuator: what the conformance tests, which know any drive, do not ask."""

import time
from math import isnan, nan

import pytest

from drivers.actuator.session import ActuatorSession
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveFault
from tests.drivers.actuators.kinds import KINDS, MIT, PERIOD_S

pytestmark = pytest.mark.virtual_time
OFF, PUSH = Command(Mode.OFF), Command(Mode.TORQUE, 0.015)
EXPECTED = {"torque_n_m": (0.015, 0.002), "current_a": (0.3, 0.04), "supply_v": (24.0, 0.2), "temperature_c": (30, 15)}
each_kind = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name, indirect=True)


def pushed(drive, cycles, torque_n_m=0.015):
    """The last sample after some cycles."""
    for _ in range(cycles):
        time.sleep(PERIOD_S)
        last = drive.exchange(Command(Mode.TORQUE, torque_n_m))
    return last


@each_kind
def test_it_says_who_it_is_and_that_it_is_simulated(kind, device):
    drive = kind.drive_of(device, **({"is_simulated": True} if kind.name == "cubemars" else {}))
    drive.open(PERIOD_S)
    found = drive.describe()
    drive.close()
    assert (found.firmware, found.simulated) == (kind.firmware, True)


@each_kind
def test_it_tells_what_it_measures_and_nothing_else(kind, drive):
    drive.enable(Mode.TORQUE)
    last = pushed(drive, 40)
    drive.disable()
    assert drive.describe().measured >= kind.measured
    for name, (value, width) in EXPECTED.items():
        found = getattr(last, name)
        assert found == pytest.approx(value, abs=width) if name in kind.measured else isnan(found), name


@pytest.mark.parametrize("kind", MIT, ids=lambda kind: kind.name, indirect=True)
def test_a_torque_beyond_its_frame_is_refused(drive):
    drive.enable(Mode.TORQUE)
    with pytest.raises(DriveConfigurationError, match=r"-0.5 .. 0.5 N m"):
        drive.exchange(Command(Mode.TORQUE, 0.6))


@each_kind
def test_a_quick_stop_ends_in_power_off(kind, drive, device):
    drive.enable(Mode.TORQUE)
    moving = pushed(drive, 20, 0.02)
    drive.quick_stop()
    torques = [drive.exchange(OFF).torque_n_m for _ in range(3) if not time.sleep(PERIOD_S)]
    assert moving.velocity_rad_s > 0.5
    assert not kind.damps or min(torques) < -0.002  # against the motion
    for _ in range(120):
        time.sleep(PERIOD_S)
        last = drive.exchange(OFF)
    assert last.status is Status.DISABLED
    device.wait_for_power(False)


@each_kind
def test_a_quick_stop_ends_in_power_off_where_the_position_is_no_number(drive, device, monkeypatch):
    take = ActuatorSession.take
    drive.enable(Mode.TORQUE)
    pushed(drive, 20, 0.02)
    drive.quick_stop()
    monkeypatch.setattr(ActuatorSession, "take", lambda self, reading: take(self, reading._replace(counts=nan)))
    for _ in range(120):
        time.sleep(PERIOD_S)
        last = drive.exchange(OFF)
    assert last.status is Status.DISABLED
    device.wait_for_power(False)


@pytest.mark.parametrize(
    ("kind", "fault"),
    [pytest.param(kind, fault, id=f"{kind.name}-{fault}") for kind in KINDS for fault in kind.faults],
    indirect=["kind"],
)
def test_a_fault_is_named_and_the_power_is_off(kind, drive, device, fault):
    drive.enable(Mode.TORQUE)
    device.side.ask("fault", name=fault)
    time.sleep(0.02)
    assert drive.exchange(Command(Mode.TORQUE, 0.002)).status is Status.FAULT
    with pytest.raises(DriveFault, match=kind.faults[fault]):
        drive.exchange(Command(Mode.TORQUE, 0.002))
    device.wait_for_power(False)
    device.side.ask("repair")
    time.sleep(0.02)
    drive.clear_fault()
    drive.enable(Mode.TORQUE)
    assert drive.exchange(Command(Mode.TORQUE, 0.0)).status is Status.ENABLED
