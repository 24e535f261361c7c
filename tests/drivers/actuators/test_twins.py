"""Two actuators of one id on a bus: both would turn, and be taken for one."""

from contextlib import ExitStack

import pytest

from drivers.can_bus.settings import BusSettings
from drivers.errors import DriveConfigurationError
from drivers.moteus.actuator import MoteusActuator
from drivers.odrive.drive import OdriveActuator
from drivers.robstride.drive import RobstrideActuator
from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.damiao.motor import DamiaoMotor
from sim_backend.devices.mit.serve import MitSimulation, serve_mit
from sim_backend.devices.moteus.serve import MoteusBusSettings, serve_moteus
from sim_backend.devices.odrive.serve import OdriveSimulation, serve_odrive
from sim_backend.devices.robstride.motor import RobstrideMotor
from tests.drivers.actuators.kinds import CUBEMARS, DAMIAO, MOTEUS, ODRIVE, PERIOD_S, ROBSTRIDE

VIRTUAL = pytest.mark.virtual_time


def mit(motor, motor_id):
    return lambda bus: serve_mit(motor, MitSimulation(**bus, motor_id=motor_id))


CASES = (
    pytest.param(DAMIAO, mit(DamiaoMotor, 1), "ESC_ID 1", id="damiao", marks=VIRTUAL),
    # in real time: each takes the answer of the other for a question, and answers that
    pytest.param(CUBEMARS, mit(CubemarsMotor, 1), r"motor_id \(1\)", id="cubemars"),
    pytest.param(ROBSTRIDE, mit(RobstrideMotor, 127), r"motor_id \(127\)", id="robstride", marks=VIRTUAL),
    pytest.param(
        ODRIVE, lambda bus: serve_odrive(OdriveSimulation(**bus)), r"node_id \(0\)", id="odrive", marks=VIRTUAL
    ),
    pytest.param(
        MOTEUS, lambda bus: serve_moteus(MoteusBusSettings(**bus)), r"servo_id \(1\)", id="moteus", marks=VIRTUAL
    ),
)


def bus_of(kind, serve, count, stack):
    """Some devices of one id at work, and a driver on their bus."""
    channel = f"{kind.name}-{count}"
    running = [stack.enter_context(serve({"interface": "virtual", "channel": channel})) for _ in range(count)]
    return running, on_bus(kind, channel)


def on_bus(kind, channel):
    return kind.on(BusSettings("virtual", channel), answer_timeout_s=0.3)


@pytest.mark.parametrize(("kind", "serve", "words"), CASES)
def test_two_of_one_id_are_refused_before_motion(kind, serve, words):
    with ExitStack() as stack:
        running, drive = bus_of(kind, serve, 2, stack)
        with pytest.raises(DriveConfigurationError, match=rf"\d+ answers came to one question: .*{words}"):
            drive.open(PERIOD_S)
        assert not any(one.device.axis.power.on for one in running)


@pytest.mark.parametrize(
    ("kind", "serve", "actuator"),
    [
        pytest.param(*case.values[:2], actuator, id=case.id, marks=VIRTUAL)
        for case, actuator in zip(CASES[2:], (RobstrideActuator, OdriveActuator, MoteusActuator), strict=True)
    ],
)
def test_they_are_refused_before_one_is_asked_who_it_is(kind, serve, actuator, monkeypatch):
    """The answer of one may be taken for that of the other to the next question."""
    monkeypatch.setattr(actuator, "_identify", lambda _actuator: pytest.fail("it was asked who it is"))
    with ExitStack() as stack:
        _, drive = bus_of(kind, serve, 2, stack)
        with pytest.raises(DriveConfigurationError, match="answers came to one question"):
            drive.open(PERIOD_S)


@pytest.mark.parametrize(("kind", "serve", "words"), CASES)
def test_one_alone_is_not(kind, serve, words):
    with ExitStack() as stack:
        _, drive = bus_of(kind, serve, 1, stack)
        drive.open(PERIOD_S)
        drive.close()


@VIRTUAL
def test_two_moteus_of_one_id_on_an_adapter_are_refused_too():
    with serve_moteus(MoteusBusSettings(ids=(1, 1))) as served:
        drive = MOTEUS.on(served.path, answer_timeout_s=0.3)
        with pytest.raises(DriveConfigurationError, match=r"2 answers came to one question: .*servo_id \(1\)"):
            drive.open(PERIOD_S)
        assert not served.device.axis.power.on
