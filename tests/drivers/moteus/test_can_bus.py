"""moteus controllers on a CAN-FD bus of python-can, without a serial adapter."""

import time

import can
import pytest

from bench.config.configuration import parse_configuration
from bench.errors import ConfigurationError
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConnectionError
from drivers.joint import JointScale
from drivers.moteus.drive import MoteusDrive
from drivers.moteus.settings import MoteusSettings
from sim_backend.devices.moteus.serve import MoteusBusSettings, serve_moteus
from tests.drivers.conformance.benches import configured

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
PUSH = Command(Mode.TORQUE, 0.015)
PERIOD_S = 0.01


def drive_on(channel, servo_id=1, **settings):
    values = {"answer_timeout_s": 0.3, "watchdog_s": 1.0} | settings
    return MoteusDrive(MoteusSettings(interface="virtual", channel=channel, servo_id=servo_id, **values), JOINT)


def test_two_on_one_bus_are_turned_in_one_exchange():
    with serve_moteus(MoteusBusSettings(ids=(1, 2), interface="virtual", channel="moteus-two")) as served:
        drives = [drive_on("moteus-two", servo_id) for servo_id in (1, 2)]
        for one in drives:
            one.open(PERIOD_S)
            one.enable(Mode.TORQUE)
        assert drives[0].bus is drives[1].bus
        for _ in range(15):
            time.sleep(PERIOD_S)
            samples = drives[0].exchange_together([(one, PUSH) for one in drives])
        assert [sample.status for sample in samples] == [Status.ENABLED] * 2
        assert all(sample.velocity_rad_s > 0.2 for sample in samples)
        for one in drives:
            one.close()
        assert served.device.report()["mode"] == 0


def test_its_frames_are_those_of_can_fd():
    """An identifier beyond 11 bits has 29; the data have a length that CAN-FD knows."""
    with (
        serve_moteus(MoteusBusSettings(interface="virtual", channel="moteus-frames")),
        can.Bus(interface="virtual", channel="moteus-frames", ignore_config=True) as listener,
    ):
        drive = drive_on("moteus-frames")
        drive.open(PERIOD_S)
        drive.close()
        heard = list(iter(lambda: listener.recv(0.0), None))
    ours = [one for one in heard if one.arbitration_id & 0xFF == 1]
    assert ours
    for one in heard:
        assert (one.is_fd, one.bitrate_switch) == (True, True)
        assert len(one.data) in (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)
    assert {(one.arbitration_id, one.is_extended_id) for one in ours} == {(0x8001, True), (0x0001, False)}


def test_silence_is_an_error_that_names_the_servo_and_the_watchdog_stops_it():
    with serve_moteus(MoteusBusSettings(interface="virtual", channel="moteus-silent")) as served:
        drive = drive_on("moteus-silent", answer_timeout_s=0.05, watchdog_s=0.3)
        drive.open(PERIOD_S)
        drive.enable(Mode.TORQUE)
        drive.exchange(PUSH)
        served.device.node.send = lambda _frame: None
        with pytest.raises(DriveConnectionError, match=r"moteus-silent servo 1.*servo_id, termination"):
            drive.exchange(PUSH)
        end_s = time.monotonic() + 3.0
        while served.device.axis.power.on:
            assert time.monotonic() < end_s
            time.sleep(0.01)
        drive.close()


@pytest.mark.parametrize(
    "place", [{}, {"port": "a", "interface": "socketcan", "channel": "can0"}, {"interface": "pcan"}]
)
def test_one_place_is_wanted(place):
    with pytest.raises(ConfigurationError, match="either port, or interface and channel are wanted"):
        configured(kind="moteus", **place)


def test_the_section_makes_a_drive_on_the_bus():
    values = configured(kind="moteus", interface="socketcan", channel="can0")
    assert parse_configuration(values.model_dump(mode="json", exclude_none=True), "bench.toml").drive == values.drive
