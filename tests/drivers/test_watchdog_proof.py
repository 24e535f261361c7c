"""A watchdog counts as proven only where the drive itself was seen to stop; a drive without one never does."""

import pytest

from bench.config.configuration import default_configuration, parse_configuration
from bench.doctor.watchdog_proof import keep_silent, prove_watchdog
from drivers.contract import Inspection, Mode, Watchdog
from drivers.joint import JointScale
from drivers.modbus.drive import ModbusDrive
from drivers.modbus.map_file import parse_map
from drivers.modbus.settings import ModbusSettings
from sim_backend.devices.modbus.serve import ModbusSettings as SimulatedModbus
from sim_backend.devices.modbus.serve import serve_modbus
from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw
from tests.control.fake_drive import FakeDrive
from tests.drivers.libmodbus_server import libmodbus_server, library

PERIOD_S = 0.02
REGISTERS = """
name = "registers that keep what is written"
source = "libmodbus"
[identity]
vendor = "libmodbus"
product = "server"
[control]
register = "control"
off = 0
duty = 1
[demand]
duty = "duty"
[measured]
position_counts = "position"
duty = "duty"
[status]
register = "control"
enabled = 1
[watchdog]
register = "watchdog"
""" + "".join(
    f'[[register]]\nname = "{name}"\nspace = "holding"\naddress = {address}\ntype = "{kind}"\nscale = {scale}\n'
    for name, address, kind, scale in (
        ("control", 0, "uint16", 1.0),
        ("duty", 1, "int16", 1e-4),
        ("position", 2, "int32", 1.0),
        ("watchdog", 10, "uint16", 1e-3),
    )
)


def bench_of(**drive):
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = PERIOD_S
    return parse_configuration(values | {"drive": {"watchdog_s": 0.4, "answer_timeout_s": 0.3, **drive}}, "bench.toml")


@pytest.mark.skipif(library() is None, reason="libmodbus is not installed (apt-get install libmodbus5)")
def test_a_server_of_libmodbus_has_no_watchdog_and_is_not_taken_for_one_that_has():
    with libmodbus_server() as port:
        settings = ModbusSettings("registers", "tcp", str(port), watchdog_s=0.3, answer_timeout_s=0.3)
        drive = ModbusDrive(settings, parse_map(REGISTERS, "map"), JointScale(4096, 20.0))
        try:
            drive.open(PERIOD_S)  # the watchdog register reads back as it was set
            found = keep_silent(drive, PERIOD_S)
        finally:
            drive.close()
    assert found.watchdog is Watchdog.NONE
    assert "its applied duty 0.02; it has to stop 0.3 s after the last demand" in found.sentence


def roboclaw():
    return serve_roboclaw(RoboClawSettings())


def modbus():
    return serve_modbus(SimulatedModbus(transport="tcp"))


def section_of(device):
    if device.device.report()["kind"] == "roboclaw":
        return {"kind": "roboclaw", "port": device.path}
    host, port = device.path.split(":")
    return {"kind": "modbus", "map": "friction-bench", "transport": "tcp", "host": host, "port": port}


@pytest.mark.parametrize("serve", [roboclaw, modbus])
def test_a_watchdog_that_stops_the_motor_is_proven_at_the_drive(serve):
    with serve() as device:
        found = prove_watchdog(bench_of(**section_of(device)))
        assert device.device.report()["watchdog_trips"] == 1
    assert found.watchdog is Watchdog.PROVEN, found.sentence
    assert "read before anything was written" in found.sentence


@pytest.mark.parametrize("serve", [roboclaw, modbus])
def test_a_watchdog_that_reads_back_and_does_nothing_is_not(serve, monkeypatch):
    with serve() as device:
        monkeypatch.setattr(device.device, "_watch", lambda: None)
        found = prove_watchdog(bench_of(**section_of(device)))
    assert found.watchdog is Watchdog.NONE, found.sentence


class Mute(FakeDrive):
    """Tells neither state nor output."""

    def inspect(self) -> Inspection:
        return Inspection(None)


def test_where_nothing_tells_it_is_not_proven():
    drive = Mute(modes=frozenset({Mode.DUTY}))
    drive.open(PERIOD_S)
    found = keep_silent(drive, PERIOD_S)
    assert found.watchdog is Watchdog.CONFIGURED
    assert "pull the cable in motion" in found.sentence
    assert not drive.powered


def test_not_a_command_goes_out_between_the_silence_and_the_look():
    drive = FakeDrive()
    drive.open(PERIOD_S)
    keep_silent(drive, PERIOD_S)
    sent = [command.value for command in drive.commands]
    assert sent == [0.02] * 6
    assert drive.calls[-2:] == ["inspect", "disable"]
