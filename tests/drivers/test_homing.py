"""`friction-bench doctor --home` on a simulated device whose count begins anew with each power cycle."""

import json
from math import pi, radians

import pytest
import tomli_w

from bench.config.configuration import default_configuration, parse_configuration, read_configuration
from bench.errors import ConfigurationError
from bench.experiments.kinds import homing
from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen
from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw
from tests.cli.conftest import command  # noqa: F401  a fixture

pytestmark = pytest.mark.virtual_time

STOP_RAD = radians(80.0)
WRONG_RAD = 0.7  # the zero that is written before: the arm hangs straight down all the same
STOPS = {"present": True, "upper_rad": STOP_RAD, "lower_rad": -STOP_RAD}


def _patient():
    """A bench's tables, its period and limits those of a device that is looked at now and then."""
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = 0.02
    values["limits"] |= {"sample_age_s": 1.0, "tracking_error_rad": 1.0}
    return values


@pytest.fixture
def device():
    with serve_roboclaw(RoboClawSettings(plant={"end_stops": STOPS})) as running:
        yield running


@pytest.fixture
def bench(command, device, tmp_path):  # noqa: F811
    """Runs `friction-bench --config bench.toml ...` on the device, with a way of homing."""

    def made(homing, **tables):
        values = _patient()
        for name, table in tables.items():
            values[name] |= table
        values["drive"] = {
            "kind": "roboclaw", "port": device.path, "side_channel": device.side_channel, "watchdog_s": 1.0,
            "answer_timeout_s": 0.3, "homing": homing,
        }  # fmt: skip
        (tmp_path / "bench.toml").write_text(tomli_w.dumps(values))
        return lambda *words: command("--config", "bench.toml", *words)

    return made


def zero(folder):
    return read_configuration(folder / "bench.toml").drive.zero_rad


def is_powered(device):
    """A moment later, by the device's own clock, and before its watchdog could be the reason."""
    axis = device.device.axis
    axis.advance_to(axis.time_s + 0.1)
    return axis.power.on


def spoil(folder):
    """A count that was reset: the zero in the file is that of another day."""
    path = folder / "bench.toml"
    path.write_text(path.read_text().replace("[drive.homing]", f"zero_rad = {WRONG_RAD}\n\n[drive.homing]"))
    assert zero(folder) == WRONG_RAD


# power goes while the arm comes in at 0.5 rad/s: it coasts J v^2 / 2 T = 0.05 rad (0.022 kg m2, 0.06 N m), beside 0.03
# of the zero, 0.03 that the set point leads, 0.01 of free play, and a cycle that a busy host is late
WITHIN_RAD = 0.14
END_STOP = {
    "method": "end-stop", "angle_rad": STOP_RAD, "direction": 1, "speed_rad_s": 0.5, "current_a": 0.6,
    "travel_rad": 2.0,
}  # fmt: skip


def test_the_end_stop_gives_the_zero_back_and_the_arm_hangs_down_afterwards(bench, device, tmp_path):
    run = bench(END_STOP)
    assert run("doctor", "--move").exit_code == 0
    spoil(tmp_path)
    found = run("doctor", "--home")
    assert found.exit_code == 0, found.output
    assert "homing: completed" in found.output
    # the stop gives way, and the teeth are wound up, by what the current presses
    assert zero(tmp_path) == pytest.approx(0.0, abs=0.03)
    assert not is_powered(device)
    assert device.device.axis.plant.truth().arm_rad == pytest.approx(0.0, abs=WITHIN_RAD)
    # a new zero, and how it was found, ask for no new commissioning move
    assert "has not passed" not in run("run", "steps", "--repeats", "1").output


def test_no_stop_within_the_travel_writes_nothing(bench, device, tmp_path):
    run = bench(END_STOP | {"travel_rad": 0.4})
    assert run("doctor", "--move").exit_code == 0
    spoil(tmp_path)
    found = run("doctor", "--home")
    assert found.exit_code != 0
    words = found.output.replace("\n", " ")
    assert "no end stop was found within 0.4 rad" in words
    assert zero(tmp_path) == WRONG_RAD
    assert not is_powered(device)
    record = json.loads(run("experiments", "--json").stdout)[0]
    assert (record["kind"], record["outcome"]) == ("homing", "failed")


def test_a_stop_that_is_not_twice_at_the_same_place_writes_nothing(bench, device, tmp_path):
    run = bench(END_STOP | {"repeat_rad": 1e-9})
    assert run("doctor", "--move").exit_code == 0
    spoil(tmp_path)
    device.device.axis.plant.loosen_clutch(0.2)  # it slips against the stop
    found = run("doctor", "--home")
    assert found.exit_code != 0, found.output
    assert zero(tmp_path) == WRONG_RAD


def test_a_drive_whose_signs_nobody_has_checked_is_not_moved_against_a_stop(bench, tmp_path):
    found = bench(END_STOP)("doctor", "--home")
    assert found.exit_code != 0
    assert "has not passed the commissioning move" in found.output.replace("\n", " ")
    assert zero(tmp_path) == 0.0


def test_more_current_than_the_servo_may_give_is_refused(bench):
    found = bench(END_STOP | {"current_a": 1.9})("doctor", "--home")
    assert found.exit_code != 0
    assert "drive.homing.current_a is 1.9 A; allowed is at most 1.6 A" in found.output.replace("\n", " ")


def test_any_other_way_than_doctor_is_refused(bench, tmp_path):
    run = bench(END_STOP)
    assert run("run", "homing").exit_code == 2
    configuration = read_configuration(tmp_path / "bench.toml")
    with pytest.raises(ConfigurationError, match="doctor --home"):
        homing.KIND.refuse(homing.HomingParameters(), configuration)


def test_a_bench_that_does_not_say_how_is_told(command):  # noqa: F811
    found = command("doctor", "--home")
    assert found.exit_code == 3
    assert "add [drive.homing]" in found.output.replace("\n", " ")


def test_an_absolute_encoder_moves_nothing(bench, device, tmp_path):
    found = bench({"method": "absolute"})("doctor", "--home")
    assert found.exit_code == 0, found.output
    assert "nothing was moved" in found.output.replace("\n", " ")
    assert device.device.axis.plant.truth().arm_rad == 0.0
    assert zero(tmp_path) == 0.0


ON_CAN = {"family": "homing", "interface": "slcan"}


@pytest.fixture
def can_device():
    with serve_canopen(CanOpenSettings(plant={"end_stops": STOPS}, **ON_CAN)) as running:
        yield running


@pytest.fixture
def can_bench(command, can_device, tmp_path):  # noqa: F811
    """Runs `friction-bench --config bench.toml ...` on a CiA 402 drive that homes by itself."""

    def made(homing, **drive):
        values = _patient()
        values["drive"] = drive | {
            "kind": "canopen", "interface": "slcan", "channel": can_device.path, "node_id": can_device.node_id,
            "side_channel": can_device.side_channel, "watchdog_s": 1.0, "answer_s": 0.6, "homing": homing,
        }  # fmt: skip
        (tmp_path / "bench.toml").write_text(tomli_w.dumps(values))
        return lambda *words: command("--config", "bench.toml", *words)

    return made


BY_DRIVE = {"method": "drive", "drive_method": -2, "angle_rad": STOP_RAD, "speed_rad_s": 0.5, "current_a": 0.8}


def test_the_drive_homes_at_the_stop_by_itself(can_bench, can_device, tmp_path):
    run = can_bench(BY_DRIVE)
    assert run("doctor", "--move").exit_code == 0
    spoil(tmp_path)
    found = run("doctor", "--home")
    assert found.exit_code == 0, found.output
    assert "homing: completed" in found.output
    # by the drive's count the stop is 0 now, and the joint stands at the angle that was said
    assert zero(tmp_path) == pytest.approx(-STOP_RAD, abs=1e-6)
    axis = can_device.device.axis
    assert axis.zero_counts == pytest.approx(STOP_RAD * 4096 * 20 / (2.0 * pi), rel=0.02)
    assert not is_powered(can_device)


def test_the_index_pulse_gives_the_same_zero_wherever_the_arm_hung(can_bench, can_device, tmp_path):
    run = can_bench(BY_DRIVE | {"drive_method": 34, "angle_rad": 0.1})
    assert run("doctor", "--move").exit_code == 0
    homes = []
    for _ in range(2):
        found = run("doctor", "--home")
        assert found.exit_code == 0, found.output
        assert zero(tmp_path) == pytest.approx(-0.1, abs=1e-6)
        homes.append(can_device.device.axis.zero_counts)
    assert all(home % 4096 == 0 for home in homes)


def test_a_homing_of_the_drive_that_goes_too_far_is_ended_and_writes_nothing(can_bench, can_device, tmp_path):
    run = can_bench(BY_DRIVE | {"travel_rad": 0.4})
    assert run("doctor", "--move").exit_code == 0
    spoil(tmp_path)
    found = run("doctor", "--home")
    assert found.exit_code != 0
    assert "0.4 rad are allowed" in found.output.replace("\n", " ")
    assert zero(tmp_path) == WRONG_RAD
    assert not is_powered(can_device)


def test_a_homing_error_of_the_drive_is_said_and_writes_nothing(can_bench, can_device, tmp_path):
    # the arm is held with no index pulse before it, and the drive gives no more than its limit
    run = can_bench(BY_DRIVE | {"drive_method": 34}, current_limit_a=0.7)
    assert run("doctor", "--move").exit_code == 0
    spoil(tmp_path)
    can_device.device.axis.hold_arm(0.1)
    found = run("doctor", "--home")
    assert found.exit_code != 0, found.output
    assert "its homing ended with an error" in found.output.replace("\n", " ")
    assert zero(tmp_path) == WRONG_RAD


def test_a_method_that_the_drive_does_not_have_is_named(can_bench, tmp_path):
    run = can_bench(BY_DRIVE | {"drive_method": 17})
    assert run("doctor", "--move").exit_code == 0
    found = run("doctor", "--home")
    assert found.exit_code != 0
    assert "homing method (0x6098:00)" in found.output.replace("\n", " ")
    assert zero(tmp_path) == 0.0


def test_a_number_is_asked_for():
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["drive"] = {"kind": "canopen", "interface": "virtual", "channel": "c", "node_id": 5}
    values["drive"]["homing"] = {"method": "drive"}
    with pytest.raises(ConfigurationError, match="drive_method"):
        parse_configuration(values, "bench.toml")
