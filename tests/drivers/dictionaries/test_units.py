"""Drives that count in units of their own: in tenths of a degree, and accelerations unlike velocities.

The right rig reads the joint where it is, the wrong one is refused; the joint speeds up as it was asked to.
"""

from contextlib import contextmanager

import pytest

from drivers.canopen.cia402.homing import DriveHoming
from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError
from sim_backend.devices.canopen.data_types import U32
from sim_backend.devices.canopen.objects.entry import Access, Entry, record
from sim_backend.devices.canopen.objects.family import Rating
from sim_backend.devices.canopen.objects.homing import homing_objects
from sim_backend.devices.joint_tables import behind_a_drive
from tests.drivers.dictionaries.attempt import OFF, PERIOD_S, cycles, device, host, push
from tests.drivers.dictionaries.traits import PROFILE_POSITION, TENTH_DEGREE, Trait

pytestmark = pytest.mark.virtual_time

FEED = record(0x6092, "Feed constant", Entry(1, "Feed", U32, Access.RW, 3600), Entry(2, "Turns", U32, Access.RW, 1))
TENTHS = Trait(added=(FEED,), default={(0x60A8, 0): TENTH_DEGREE, (0x60A9, 0): 0})
HOMING = 1 << 5  # of 0x6502
OTHERWISE = {(0x6502, 0): PROFILE_POSITION | HOMING}
HOMES = tuple(homing_objects(Rating.of(behind_a_drive())))
FACTOR = record(0x6097, "Acceleration factor", Entry(1, "Over", U32, default=1), Entry(2, "Under", U32, default=50))
# velocities are counts a second
ACCELERATIONS = {
    "thousandths-of-a-turn": Trait(default=OTHERWISE | {(0x60AA, 0): 0xFDB45700}, added=HOMES),
    "rpm-a-second": Trait(default=OTHERWISE | {(0x60AA, 0): 0x00C00300}, added=HOMES),
    "factor": Trait(default=OTHERWISE, without=(0x60AA,), added=(*HOMES, FACTOR)),
    "not-told": Trait(default=OTHERWISE, without=(0x60AA,), added=HOMES),
}
HOW = {
    "profile_speed_rad_s": 4.0,
    "profile_acceleration_rad_s2": 2.0,
    "homing": DriveHoming(34, 4.0, 4.0, 2.0),
}


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


@contextmanager
def speeding(name, folder):
    """A drive, open, and what tells its speed after some time of a command [rad/s]."""
    with device(ACCELERATIONS[name].write(folder, name)) as running, host(running, **HOW) as drive:
        drive.open(PERIOD_S)

        def speed_rad_s(command, duration_s):
            cycles(drive, command, duration_s)
            with running.device.lock:
                return running.device.axis.seen.velocity_rad_s

        yield drive, speed_rad_s


@pytest.mark.parametrize("name", ACCELERATIONS)
def test_a_profile_speeds_up_and_slows_down_as_asked(name, tmp_path) -> None:
    with speeding(name, tmp_path) as (drive, speed_rad_s):
        start_rad = cycles(drive, OFF, 0.05).position_rad
        drive.enable(Mode.POSITION)
        there = Command(Mode.POSITION, start_rad + 0.5)  # half of the way, and of 1 s, at 2 rad/s2
        assert speed_rad_s(there, 0.3) == pytest.approx(0.6, abs=0.1)
        assert speed_rad_s(there, 0.2) == pytest.approx(1.0, abs=0.1)
        assert speed_rad_s(there, 0.2) == pytest.approx(0.6, abs=0.1)


@pytest.mark.parametrize("name", ACCELERATIONS)
def test_homing_speeds_up_as_asked(name, tmp_path) -> None:
    with speeding(name, tmp_path) as (drive, speed_rad_s):
        drive.enable(Mode.HOME)
        assert speed_rad_s(Command(Mode.HOME, 1.0), 0.3) == pytest.approx(0.6, abs=0.1)
