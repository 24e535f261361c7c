"""What only a CubeMars actuator does: it has no watchdog, does not say its ranges, and keeps what it was told last."""

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError, DriveConnectionError, WatchdogError
from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.mit.serve import MitSimulation, serve_mit
from tests.drivers.actuators.kinds import CUBEMARS, PERIOD_S

pytestmark = pytest.mark.virtual_time


@pytest.fixture(scope="module")
def kind():
    return CUBEMARS


def test_nobody_runs_it_unknowingly(device):
    with pytest.raises(WatchdogError, match="accept_no_watchdog = true"):
        CUBEMARS.drive_of(device, accept_no_watchdog=False).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_ranges_that_are_not_known_are_refused_before_anything_is_sent(device):
    with pytest.raises(DriveConfigurationError, match="a wrong range is a wrong torque"):
        CUBEMARS.drive_of(device, torque_range_n_m=0.0).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_what_it_is_told_last_is_no_torque():
    """It keeps that, and begins with it where it is enabled again."""
    with serve_mit(CubemarsMotor, MitSimulation(interface="virtual", channel="cubemars-last")) as served:
        drive = CUBEMARS.on(BusSettings("virtual", "cubemars-last"))
        drive.open(PERIOD_S)
        drive.enable(Mode.TORQUE)
        drive.exchange(Command(Mode.TORQUE, 0.02))
        assert served.device.command.torque_n_m == pytest.approx(0.02, abs=1e-3)
        drive.disable()
        assert served.device.command.torque_n_m == pytest.approx(0.0, abs=2e-4)
        assert not served.device.is_on
        drive.close()


def test_answers_of_another_identifier_are_not_taken(device):
    with pytest.raises(DriveConnectionError, match=r"feedback_id \(0\)"):
        CUBEMARS.drive_of(device, feedback_id=0, answer_timeout_s=0.02).open(PERIOD_S)
