"""An actuator that another host drives on a CAN bus, recorded by who only listens: makers' packages are that host."""

import asyncio
import threading
import time
from contextlib import ExitStack, contextmanager
from math import nan

import can
import damiao_motor
import moteus
import numpy as np
import pytest
from moteus.pythoncan_device import PythonCanDevice
from odrive_can.odrive import ODriveCAN

from bench.errors import ConfigurationError
from bench.runs.follow import follower_of, pass_on, record
from drivers.can_bus.port import CanPort
from drivers.can_bus.settings import BusSettings
from drivers.cubemars import protocol as cubemars
from drivers.damiao import protocol as damiao
from drivers.errors import DriveConfigurationError
from drivers.mit import frames
from drivers.robstride import protocol as robstride
from sim_backend.devices.cubemars.motor import CubemarsMotor
from sim_backend.devices.damiao.motor import DamiaoMotor
from sim_backend.devices.mit.serve import MitSimulation, serve_mit
from sim_backend.devices.moteus.serve import MoteusBusSettings, serve_moteus
from sim_backend.devices.odrive.serve import OdriveSimulation, serve_odrive
from sim_backend.devices.robstride.motor import RobstrideMotor
from tests.drivers.conformance.benches import configured
from tests.drivers.robstride.test_foreign_peer import peer

TORQUE_N_M = 0.02
CYCLES, PERIOD_S = 160, 0.01  # longer than is recorded
HOST_MAY_WAIT_S = 5.0  # of a watchdog: host, device and listener share one process here, and a busy machine


def swing(push):
    """Push to and fro."""
    for number in range(CYCLES):
        push(TORQUE_N_M if number // 20 % 2 == 0 else -TORQUE_N_M)
        time.sleep(PERIOD_S)


def damiao_host(bus):
    top = damiao.MODELS["DMH3510"]
    motor = damiao_motor.DaMiaoMotor(
        1, 0x11, bus, motor_type="4310", p_min=-top[0], p_max=top[0], v_min=-top[1], v_max=top[1], t_min=-top[2],
        t_max=top[2],
    )  # fmt: skip
    motor.enable()
    motor.request_register_reading(23)  # the answer has the same identifier
    swing(lambda torque_n_m: motor.send_cmd_mit(0.0, 0.0, 0.0, 0.0, torque_n_m))
    motor.disable()


def cubemars_host(bus):
    def send(data):
        bus.send(can.Message(arbitration_id=1, data=data, is_extended_id=False))

    send(frames.ENABLE)
    swing(lambda torque_n_m: send(frames.command(cubemars.MODELS["AK40-10"], torque_n_m)))
    send(frames.DISABLE)


def robstride_host(bus):
    with peer(bus, "rs-02") as made:
        made.host_id = 0xA0
        made.enable("joint")
        swing(lambda torque_n_m: made.write_operation_frame("joint", 0.0, 0.0, 0.0, 0.0, torque_n_m))
        made.disable("joint")


def odrive_host(bus):
    async def drive():
        client = ODriveCAN(axis_id=0, can_bus=bus)
        await client.start()
        try:
            client.set_controller_mode("TORQUE_CONTROL", "PASSTHROUGH")
            await client.set_axis_state("CLOSED_LOOP_CONTROL")
            for number in range(CYCLES):
                client.set_input_torque(TORQUE_N_M if number // 20 % 2 == 0 else -TORQUE_N_M)
                await client._request("Get_Iq")
                await asyncio.sleep(PERIOD_S)
            await client.set_axis_state("IDLE")
        finally:
            client.stop()

    asyncio.run(drive())


def moteus_host(bus):
    """The library asks for what it does by default, and for the current."""

    async def drive():
        device = PythonCanDevice(interface="virtual", channel=bus.channel_id, ignore_config=True, disable_brs=True)
        resolution = moteus.QueryResolution()
        resolution.q_current = moteus.F32
        controller = moteus.Controller(id=1, query_resolution=resolution, transport=moteus.Transport([device]))
        await controller.set_stop()
        for number in range(CYCLES):
            await controller.set_position(
                position=nan, velocity=0.0, kp_scale=0.0, kd_scale=0.0, watchdog_timeout=HOST_MAY_WAIT_S, query=True,
                feedforward_torque=TORQUE_N_M if number // 20 % 2 == 0 else -TORQUE_N_M,
            )  # fmt: skip
            await asyncio.sleep(PERIOD_S)
        await controller.set_stop()
        device.close()

    asyncio.run(drive())


def mit(motor, channel, top, motor_id=1):
    settings = MitSimulation(interface="virtual", channel=channel, ranges=top[:3], motor_id=motor_id)
    return lambda: serve_mit(motor, settings)


HOSTS = {
    "damiao": (damiao_host, mit(DamiaoMotor, "damiao", damiao.MODELS["DMH3510"]), {"model": "DMH3510"}),
    "cubemars": (cubemars_host, mit(CubemarsMotor, "cubemars", cubemars.MODELS["AK40-10"]), {"model": "AK40-10"}),
    "robstride": (robstride_host, mit(RobstrideMotor, "robstride", robstride.MODELS["RS02"], 127), {"model": "RS02"}),
    "moteus": (moteus_host, lambda: serve_moteus(MoteusBusSettings(interface="virtual", channel="moteus")), {}),
    "odrive": (
        odrive_host,
        lambda: serve_odrive(OdriveSimulation(interface="virtual", channel="odrive", watchdog_s=HOST_MAY_WAIT_S)),
        {},
    ),
}


@contextmanager
def at_work(kind, tmp_path):
    """A device, what listens to it, and a host that has begun to drive it."""
    host, serve, section = HOSTS[kind]
    configuration = configured(kind=kind, interface="virtual", channel=kind, **section)
    with ExitStack() as stack:
        served = stack.enter_context(serve())
        bus = stack.enter_context(can.Bus(interface="virtual", channel=kind, ignore_config=True))
        follower = follower_of(configuration, tmp_path / "unused", 0.01)
        stack.callback(follower.close)
        thread = threading.Thread(target=host, args=(bus,))
        stack.callback(thread.join)
        thread.start()
        yield served, configuration, follower


def refuse(*_arguments, **_options):
    raise AssertionError("who listens has sent a frame")


@pytest.mark.parametrize("kind", HOSTS)
def test_what_it_tells_another_host_is_recorded_and_nothing_is_sent(kind, tmp_path, monkeypatch):
    monkeypatch.setattr(CanPort, "send_prepared", refuse)
    with at_work(kind, tmp_path) as (served, configuration, follower):
        recording = record(follower, configuration, "swing", {}, 1.2, lambda: False)
        pass_on(follower, lambda: False)
        assert served.device.axis.power.on, "nobody waits for the other host to leave: nothing goes through here"
    found = recording.channels
    assert len(recording) > 40
    assert np.ptp(found["position_rad"]) > 0.05
    # summed up: a frame that is read late makes one step too long and the next too short, and leaves the way as it is
    velocity_rad_s, steps_s = found["velocity_rad_s"], np.diff(found["time_s"])
    travelled_rad = np.cumsum(0.5 * (velocity_rad_s[1:] + velocity_rad_s[:-1]) * steps_s)
    position_rad = found["position_rad"][1:]
    assert np.corrcoef(travelled_rad, position_rad)[0, 1] > 0.9
    assert np.polyfit(travelled_rad, position_rad, 1)[0] == pytest.approx(1.0, abs=0.2)
    current_a = found["current_a"][np.isfinite(found["current_a"])]
    assert current_a.max() == pytest.approx(TORQUE_N_M / 0.05, abs=0.08)  # N m/A of the preset `paper`
    assert current_a.min() == pytest.approx(-TORQUE_N_M / 0.05, abs=0.08)


def test_ranges_of_a_damiao_that_is_not_asked_have_to_be_known(tmp_path):
    configuration = configured(kind="damiao", interface="virtual", channel="nobody")
    with pytest.raises(DriveConfigurationError, match=r"drive\.model is left out\. Its ranges are not asked for"):
        follower_of(configuration, tmp_path / "unused", 0.01)


def test_a_bus_on_which_nothing_comes_is_said_so(tmp_path):
    configuration = configured(kind="odrive", interface="virtual", channel="nobody")
    follower = follower_of(configuration, tmp_path / "unused", 0.01)
    asked = iter((False, True))
    with pytest.raises(ConfigurationError, match=r"0 samples .* drive it on the bus nobody, and have it answer"):
        record(follower, configuration, "nothing", {}, 1.0, lambda: next(asked))
    follower.close()


def test_a_moteus_behind_an_adapter_of_another_program_cannot_be_heard(tmp_path):
    with pytest.raises(ConfigurationError, match=r"drive\.port is '/dev/fdcanusb': .* drive\.interface"):
        follower_of(configured(kind="moteus", port="/dev/fdcanusb"), tmp_path / "unused", 0.01)


def test_a_serial_adapter_listens_only():
    assert BusSettings("slcan", "/dev/ttyACM0").listening().arguments()["listen_only"] is True
    assert BusSettings("socketcan", "can0").listening().arguments() == BusSettings("socketcan", "can0").arguments()
