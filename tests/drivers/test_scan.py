"""`friction-bench drives scan`: what is found on simulated devices, and that its section opens the drive."""

import json

import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.cli.operation.drives import found_at
from bench.control.drive_factory import make_equipment
from sim_backend.devices.moteus.serve import MoteusBusSettings, serve_moteus
from tests.devices.device_process import device_process
from tests.drivers.conformance.benches import configured

ACCEPTED = {
    "feetech": {"accept_no_watchdog": True},
    "odrive": {"watchdog_is_set_in_drive": True},
    "robstride": {"position_range_rad": 100.0, "speed_range_rad_s": 200.0, "torque_range_n_m": 0.5},
}


pytestmark = pytest.mark.virtual_time
REAL = pytest.mark.real_wire


def scan(*options):
    return CliRunner().invoke(app, ["drives", "scan", *options])


@pytest.mark.parametrize(
    ("kind", "device", "key", "ids"),
    [
        pytest.param("dynamixel", ("--id", "7", "--joints", "3", "--baud", "0"), "servo_id", [7, 8, 9], marks=REAL),
        ("feetech", ("--id", "250", "--joints", "2", "--baud", "0"), "servo_id", [250, 251]),
        ("roboclaw", ("--address", "130", "--baud", "0"), "address", [130]),
        pytest.param("odrive", ("--node", "12"), "node_id", [12], marks=REAL),
        ("damiao", ("--motor", "5", "--feedback", "37"), "motor_id", [5]),
        ("robstride", ("--motor", "9"), "motor_id", [9]),
        ("moteus", ("--id", "7", "--joints", "2"), "servo_id", [7, 8]),
        ("moteus", ("--id", "7", "--uart"), "servo_id", [7]),
    ],
)
def test_it_finds_them_and_what_it_prints_opens_them(kind, device, key, ids):
    with device_process(kind, *device) as running:
        is_serial = "port" in running.drive
        bauds = ("--baud", "115200") if kind == "roboclaw" else ("--baud", "1000000")
        place = ("--port", running.port, *bauds) if is_serial else ("--bus", f"slcan:{running.port}")
        done = scan(*place, "--json")
        assert done.exit_code == 0, done.output
        found = json.loads(done.stdout)
        assert [one["drive"][key] for one in found if one["drive"]["kind"] == kind] == ids
        assert not running.truth()["powered"]
        section = found[[one["drive"]["kind"] for one in found].index(kind)]["drive"] | ACCEPTED.get(kind, {})
        drive = make_equipment(configured(**section, answer_timeout_s=0.3)).drive
        try:
            drive.open(0.01)
            assert drive.describe().simulated
        finally:
            drive.close()


def test_moteus_is_found_on_can_fd_where_that_is_asked_for():
    """Its frames are errors to nodes of classic CAN: without --fd none is sent."""
    with serve_moteus(MoteusBusSettings(ids=(3, 9), interface="virtual", channel="scan-fd")):
        found = list(found_at("", bus="virtual:scan-fd", is_fd=True))
        assert list(found_at("", bus="virtual:scan-fd")) == []
        assert [one.drive["servo_id"] for one in found] == [3, 9]
        drive = make_equipment(configured(**found[1].drive, answer_timeout_s=0.3)).drive
        drive.open(0.01)
        assert drive.describe().simulated
        drive.close()


def test_nothing_there_is_said_so():
    with device_process("dynamixel", "--baud", "0") as running:
        running.side.ask("link", name="silent")
        found = scan("--port", running.port, "--baud", "1000000")
    assert found.exit_code != 0
    assert "Nothing answers" in found.output


def test_a_place_is_wanted():
    assert "--port PORT" in scan().output
