"""A drive that counts in tenths of a degree: the right rig reads the joint where it is, the wrong one is refused."""

import pytest

from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError
from sim_backend.devices.canopen.data_types import U32
from sim_backend.devices.canopen.objects.entry import Access, Entry, record
from tests.drivers.dictionaries.attempt import OFF, PERIOD_S, cycles, device, host, push
from tests.drivers.dictionaries.traits import TENTH_DEGREE, Trait

pytestmark = pytest.mark.virtual_time

FEED = record(0x6092, "Feed constant", Entry(1, "Feed", U32, Access.RW, 3600), Entry(2, "Turns", U32, Access.RW, 1))
TENTHS = Trait(added=(FEED,), default={(0x60A8, 0): TENTH_DEGREE, (0x60A9, 0): 0})
GEAR_RATIO = 20.0


@pytest.fixture
def running(tmp_path):
    with device(TENTHS.write(tmp_path, "tenths")) as made:
        yield made


@pytest.mark.parametrize("mode", [Mode.CURRENT, Mode.POSITION])
def test_the_joint_is_read_where_it_is(running, mode) -> None:
    with host(running, counts_per_turn=3600) as drive:
        drive.open(PERIOD_S)
        start_rad = cycles(drive, OFF, 0.05).position_rad
        drive.enable(mode)
        cycles(drive, push(drive, mode, start_rad), 0.5)
        drive.disable()
        cycles(drive, OFF, 0.5)  # it comes to rest
        sample = cycles(drive, OFF, 0.1)
        with running.device.lock:
            truth_rad = running.device.axis.seen.position_rad
        assert abs(truth_rad - start_rad) > 0.01
        assert sample.position_rad == pytest.approx(truth_rad, abs=2e-3)


def test_the_encoders_own_resolution_is_refused_for_the_rig(running) -> None:
    with host(running, counts_per_turn=4096) as drive, pytest.raises(DriveConfigurationError, match="3600 by feed"):
        drive.open(PERIOD_S)


def test_velocity_follows_the_position_unit_where_a_factor_says_so(running) -> None:
    with host(running, counts_per_turn=3600, velocity_unit="counts/s") as drive:
        drive.open(PERIOD_S)
        drive.enable(Mode.CURRENT)
        sample = cycles(drive, Command(Mode.CURRENT, 0.3), 0.2)
        with running.device.lock:
            truth_rad_s = running.device.axis.seen.velocity_rad_s
        assert sample.velocity_rad_s == pytest.approx(truth_rad_s, rel=0.5)
