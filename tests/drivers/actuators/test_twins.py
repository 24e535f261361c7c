"""Two actuators of one id on a bus: both would turn, and be taken for one."""

from contextlib import ExitStack
from functools import partial

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.errors import DriveConfigurationError
from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.damiao.motor import DamiaoMotor
from sim_backend.devices.mit.serve import MitSimulation, serve_mit
from sim_backend.devices.robstride.motor import RobstrideMotor
from tests.drivers.actuators.kinds import CUBEMARS, DAMIAO, PERIOD_S, ROBSTRIDE

CASES = (
    pytest.param(DAMIAO, DamiaoMotor, 1, "ESC_ID 1", id="damiao"),
    pytest.param(CUBEMARS, CubemarsMotor, 1, r"motor_id \(1\)", id="cubemars"),
    pytest.param(ROBSTRIDE, RobstrideMotor, 127, r"motor_id \(127\)", id="robstride"),
)


def bus_of(kind, motor, motor_id, count, stack):
    """Some devices of one id at work, and a driver on their bus."""
    channel = f"{kind.name}-{count}"
    start = partial(serve_mit, motor, MitSimulation(interface="virtual", channel=channel, motor_id=motor_id))
    running = [stack.enter_context(start()) for _ in range(count)]
    return running, kind.on(BusSettings("virtual", channel), answer_timeout_s=0.3)


@pytest.mark.parametrize(("kind", "motor", "motor_id", "words"), CASES)
def test_two_of_one_id_are_refused_before_motion(kind, motor, motor_id, words):
    with ExitStack() as stack:
        running, drive = bus_of(kind, motor, motor_id, 2, stack)
        with pytest.raises(DriveConfigurationError, match=rf"\d+ answers came to one question: .*{words}"):
            drive.open(PERIOD_S)
        assert not any(one.device.is_on for one in running)


@pytest.mark.parametrize(("kind", "motor", "motor_id", "words"), CASES)
def test_one_alone_is_not(kind, motor, motor_id, words):
    with ExitStack() as stack:
        _, drive = bus_of(kind, motor, motor_id, 1, stack)
        drive.open(PERIOD_S)
        drive.close()
