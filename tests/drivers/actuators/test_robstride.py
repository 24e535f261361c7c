"""What only a RobStride actuator does: its torque limit and its position show which range its firmware has."""

import pytest

from drivers.errors import DriveConfigurationError
from tests.drivers.actuators.kinds import PERIOD_S, ROBSTRIDE

pytestmark = pytest.mark.virtual_time


@pytest.fixture(scope="module")
def kind():
    return ROBSTRIDE


def test_a_torque_limit_beyond_the_range_is_another_model(device):
    with pytest.raises(DriveConfigurationError, match=r"torque limit is 0.5 N m, and its frames would end at 0.4 N m"):
        ROBSTRIDE.drive_of(device, torque_range_n_m=0.4).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_a_range_of_positions_that_is_not_its_own_is_seen_before_motion(device):
    device.side.ask("hold", angle_rad=0.3)
    device.side.ask("release")
    with pytest.raises(DriveConfigurationError, match="its firmware has another range"):
        ROBSTRIDE.drive_of(device, position_range_rad=50.0).open(PERIOD_S)
    assert not device.truth()["powered"]


def test_its_serial_number_is_told(drive):
    assert drive.describe().serial == "5349 4d55 4c41 5445"
