"""A watchdog counts as proven only where the drive itself was seen to stop; a drive without one never does."""

import pytest

from bench.config.configuration import default_configuration, parse_configuration
from bench.control.drive_factory import make_equipment
from bench.errors import LimitTrip
from bench.runs.watchdog_proof import prove_watchdog
from drivers.contract import Inspection, Watchdog
from drivers.joint import JointScale
from drivers.modbus.drive import ModbusDrive
from drivers.modbus.map_file import parse_map
from drivers.modbus.settings import ModbusSettings
from sim_backend.devices.canopen.conduct import Conduct
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen
from sim_backend.devices.modbus.serve import ModbusSettings as SimulatedModbus
from sim_backend.devices.modbus.serve import serve_modbus
from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw
from tests.control.fake_drive import FakeDrive
from tests.devices.device_process import IS_VIRTUAL
from tests.drivers.libmodbus_server import libmodbus_server, library

pytestmark = pytest.mark.virtual_time
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


def bench_of(limits=None, **drive):
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = PERIOD_S
    values["limits"] |= {"sample_age_s": 1.0} | (limits or {})
    drive = {"watchdog_s": 0.4, "answer_timeout_s": 0.3} | drive
    told = {name: value for name, value in drive.items() if value is not None}
    return parse_configuration(values | {"drive": told}, "bench.toml")


FAKE = {"kind": "roboclaw", "port": "/dev/null"}  # a section that the fake drive stands for


def proven(**section):
    """The proof on a drive that is opened for it."""
    bench = bench_of(**section)
    drive = make_equipment(bench).drive
    try:
        drive.open(PERIOD_S)
        return prove_watchdog(drive, bench)
    finally:
        drive.close()


@pytest.mark.real_wire
@pytest.mark.skipif(IS_VIRTUAL, reason="its server is a process")
@pytest.mark.skipif(library() is None, reason="libmodbus is not installed (apt-get install libmodbus5)")
def test_a_server_of_libmodbus_has_no_watchdog_and_is_not_taken_for_one_that_has():
    with libmodbus_server() as port:
        settings = ModbusSettings(
            map="registers", transport="tcp", port=str(port), watchdog_s=0.3, answer_timeout_s=0.3
        )
        drive = ModbusDrive(settings, parse_map(REGISTERS, "map"), JointScale(4096, 20.0))
        try:
            drive.open(PERIOD_S)  # the watchdog register reads back as it was set
            found = prove_watchdog(drive, bench_of(**FAKE))
        finally:
            drive.close()
    assert found.watchdog is Watchdog.NONE
    assert "its applied duty 0.02; it has to stop 0.3 s after the last demand" in found.sentence


def roboclaw():
    return serve_roboclaw(RoboClawSettings())


def modbus():
    return serve_modbus(SimulatedModbus())


def section_of(device):
    if device.device.report()["kind"] == "roboclaw":
        return {"kind": "roboclaw", "port": device.path}
    return {"kind": "modbus", "map": "friction-bench", "transport": "rtu", "port": device.path}


@pytest.mark.parametrize("serve", [pytest.param(roboclaw, marks=pytest.mark.real_wire), modbus])
def test_a_watchdog_that_stops_the_motor_is_proven_at_the_drive(serve):
    with serve() as device:
        found = proven(**section_of(device))
        assert device.device.report()["watchdog_trips"] == 1
    assert found.watchdog is Watchdog.PROVEN, found.sentence
    assert "read before anything was written" in found.sentence


@pytest.mark.parametrize("serve", [roboclaw, modbus])
def test_a_watchdog_that_reads_back_and_does_nothing_is_not(serve, monkeypatch):
    with serve() as device:
        monkeypatch.setattr(device.device, "_watch", lambda: None)
        found = proven(**section_of(device))
    assert found.watchdog is Watchdog.NONE, found.sentence


@pytest.mark.parametrize(("is_deaf", "watchdog"), [(False, Watchdog.PROVEN), (True, Watchdog.NONE)])
def test_a_canopen_drive_that_takes_the_settings_and_never_watches_is_found_out(is_deaf, watchdog):
    channel = f"proof-{is_deaf}"
    settings = CanOpenSettings(interface="virtual", channel=channel, conduct=Conduct(deaf=is_deaf))
    with serve_canopen(settings) as device:
        found = proven(
            kind="canopen", interface="virtual", channel=channel, node_id=5, answer_s=0.3, answer_timeout_s=None
        )
        assert found.watchdog is watchdog, found.sentence
        assert not device.device.axis.power.on


class Mute(FakeDrive):
    """Tells neither state nor output."""

    def inspect(self) -> Inspection:
        return Inspection(None)


def opened(drive):
    drive.open(PERIOD_S)
    return drive


def test_where_nothing_tells_it_is_not_proven():
    drive = opened(Mute())
    found = prove_watchdog(drive, bench_of(**FAKE))
    assert found.watchdog is Watchdog.CONFIGURED
    assert "pull the cable in motion" in found.sentence
    assert not drive.powered


def test_not_a_command_goes_out_between_the_silence_and_the_look():
    drive = opened(FakeDrive())
    found = prove_watchdog(drive, bench_of(**FAKE))
    assert found.watchdog is Watchdog.PROVEN
    looks = [place for place, call in enumerate(drive.calls) if call == "inspect"]
    assert len(looks) == 2
    assert drive.calls[looks[1] :] == ["inspect", "disable", "clear_fault"]
    assert {command.value for command in drive.commands} == {0.0, 0.02}


def test_the_demand_is_held_under_the_limits_for_as_long_as_the_silence_before_it():
    drive = opened(FakeDrive())
    prove_watchdog(drive, bench_of(**FAKE))
    held = [command for command in drive.commands if command.value == 0.02]
    assert len(held) * PERIOD_S > 0.7 * 0.25  # the silence: 1.5 times 0.1 s and 0.1 s


def test_a_joint_that_moves_under_the_demand_is_given_less():
    drive = opened(FakeDrive())
    drive.friction_n_m = 0.08  # of 0.12 N m that a duty of 0.02 makes
    found = prove_watchdog(drive, bench_of(**FAKE))
    assert found.watchdog is Watchdog.PROVEN
    assert "duty 0.01 was held before, and the joint stood" in found.sentence


def test_a_joint_that_never_stands_is_not_left_to_itself():
    drive = opened(FakeDrive())
    drive.friction_n_m, drive.load_torque_n_m, drive.position_rad = 0.0, 0.5, 0.3  # it swings
    found = prove_watchdog(drive, bench_of(**FAKE))
    assert found.watchdog is Watchdog.CONFIGURED
    assert "not tried: the joint does not stand still" in found.sentence
    assert "inspect" not in drive.calls
    assert not drive.powered


def test_a_limit_ends_it():
    drive = opened(FakeDrive())
    drive.friction_n_m = 0.0
    with pytest.raises(LimitTrip, match="speed is"):
        prove_watchdog(drive, bench_of(limits={"speed_rad_s": 0.05}, **FAKE))
    assert not drive.powered


def test_a_stop_ends_the_silence():
    drive = opened(FakeDrive())
    assert prove_watchdog(drive, bench_of(**FAKE), lambda: "inspect" in drive.calls) is None
    assert drive.calls.count("inspect") == 1
    assert not drive.powered
