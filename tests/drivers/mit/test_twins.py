"""Two actuators of one id on a bus: both would turn, and be taken for one."""

from contextlib import ExitStack

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.cubemars.drive import CubemarsDrive
from drivers.cubemars.settings import CubemarsSettings
from drivers.damiao.drive import DamiaoDrive
from drivers.damiao.settings import DamiaoSettings
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.robstride.drive import RobstrideDrive
from drivers.robstride.settings import RobstrideSettings
from sim_backend.devices.cubemars.serve import CubemarsSimulation, serve_cubemars
from sim_backend.devices.damiao.serve import DamiaoSimulation, serve_damiao
from sim_backend.devices.robstride.serve import RobstrideSimulation, serve_robstride

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
RANGES = (100.0, 200.0, 0.5)
WRITTEN = dict(zip(("position_range_rad", "speed_range_rad_s", "torque_range_n_m"), RANGES, strict=True))


def damiao(channel, count):
    devices = [lambda: serve_damiao(DamiaoSimulation(interface="virtual", channel=channel, ranges=RANGES))] * count
    settings = DamiaoSettings(BusSettings("virtual", channel), watchdog_s=1.0, answer_timeout_s=0.3)
    return devices, DamiaoDrive(settings, JOINT), "ESC_ID 1"


def cubemars(channel, count):
    devices = [lambda: serve_cubemars(CubemarsSimulation(interface="virtual", channel=channel, ranges=RANGES))] * count
    bus = BusSettings("virtual", channel)
    settings = CubemarsSettings(bus, accept_no_watchdog=True, answer_timeout_s=0.3, **WRITTEN)
    return devices, CubemarsDrive(settings, JOINT), r"motor_id \(1\)"


def robstride(channel, count):
    simulation = RobstrideSimulation(interface="virtual", channel=channel, ranges=RANGES)
    settings = RobstrideSettings(BusSettings("virtual", channel), watchdog_s=1.0, answer_timeout_s=0.3, **WRITTEN)
    return [lambda: serve_robstride(simulation)] * count, RobstrideDrive(settings, JOINT), r"motor_id \(127\)"


@pytest.mark.parametrize("make", [damiao, cubemars, robstride])
def test_two_of_one_id_are_refused_before_motion(make):
    devices, drive, words = make(f"{make.__name__}-twins", 2)
    with ExitStack() as stack:
        running = [stack.enter_context(start()) for start in devices]
        with pytest.raises(DriveConfigurationError, match=rf"\d+ answers came to one question: .*{words}"):
            drive.open(0.01)
        assert not any(one.device.is_on for one in running)


@pytest.mark.parametrize("make", [damiao, cubemars, robstride])
def test_one_alone_is_not(make):
    devices, drive, _ = make(f"{make.__name__}-alone", 1)
    with ExitStack() as stack:
        for start in devices:
            stack.enter_context(start())
        drive.open(0.01)
        drive.close()
