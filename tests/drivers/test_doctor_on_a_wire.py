"""`friction-bench doctor --move` on a simulated device: the proof of its watchdog, in the record of every run after."""

import json
from math import pi

import pytest
import tomli_w

from bench.config.configuration import default_configuration, read_configuration
from bench.store import Store
from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw
from tests.cli.conftest import command  # noqa: F401  a fixture

pytestmark = pytest.mark.virtual_time


@pytest.fixture
def device():
    with serve_roboclaw(RoboClawSettings()) as running:
        yield running


@pytest.fixture
def on_device(command, device, tmp_path):  # noqa: F811
    """Runs `friction-bench --config bench.toml ...` on the device."""
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = 0.02
    values["limits"] |= {"sample_age_s": 1.0, "tracking_error_rad": 1.0}
    values["drive"] = {
        "kind": "roboclaw", "port": device.path, "side_channel": device.side_channel, "watchdog_s": 1.0,
        "answer_timeout_s": 0.3,
    }  # fmt: skip
    (tmp_path / "bench.toml").write_text(tomli_w.dumps(values))
    return lambda *words: command("--config", "bench.toml", *words)


def watchdogs(folder):
    """What the records say, the newest first."""
    with Store.open(f"sqlite:///{folder / 'friction-bench.sqlite'}") as store:
        return [found.provenance["drive"]["watchdog"] for found in store.experiments()]


def test_the_commands_that_are_named_are_those_of_this_bench(on_device):
    """Pasted without --config they would go to the simulated bench of the paper."""
    found = on_device("doctor").output.replace("\n", " ")
    assert "'friction-bench --config bench.toml doctor --move'" in found
    assert "'friction-bench --config bench.toml doctor --set-zero'" in found
    refused = on_device("run", "steps", "--repeats", "1").output.replace("\n", " ")
    assert "run 'friction-bench --config bench.toml doctor --move'" in refused


def test_what_doctor_has_seen_is_in_the_record_of_each_run_after(on_device, tmp_path):
    found = on_device("doctor", "--move")
    assert found.exit_code == 0, found.output
    assert "watchdog: proven: after 1.6 s of silence" in found.output.replace("\n", " ")
    assert watchdogs(tmp_path) == ["configured, not proven"]  # before it was tried
    ran = on_device("run", "steps", "--repeats", "1")
    assert "refused" not in ran.output
    assert watchdogs(tmp_path)[0] == "proven"


def test_a_drive_that_goes_on_is_not_moved_any_further(on_device, device, monkeypatch):
    monkeypatch.setattr(device.device, "_watch", lambda: None)
    found = on_device("doctor", "--move")
    assert found.exit_code != 0
    assert "watchdog: DOES NOT STOP IT" in found.output
    [record] = json.loads(on_device("experiments", "--json").stdout)
    assert record["outcome"] == "failed"
    assert record["results"]["watchdog"] == "none"
    assert "travel_rad" not in record["results"]
    refused = on_device("run", "steps", "--repeats", "1")
    assert "has not passed the commissioning move" in refused.output.replace("\n", " ")


def test_a_commissioning_that_nobody_started_from_doctor_proves_it_too(on_device, tmp_path):
    ran = on_device("run", "commissioning")
    assert ran.exit_code == 0, ran.output
    on_device("run", "steps", "--repeats", "1")
    assert watchdogs(tmp_path)[0] == "proven"


def test_a_pass_does_not_outlive_a_watchdog_that_has_been_seen_to_fail(on_device, device, monkeypatch):
    assert on_device("run", "commissioning").exit_code == 0
    monkeypatch.setattr(device.device, "_watch", lambda: None)
    assert "does not stop it" in on_device("run", "commissioning").output.replace("\n", " ")
    refused = on_device("run", "steps", "--repeats", "1")
    assert "has not passed the commissioning move" in refused.output.replace("\n", " ")


def test_the_zero_is_where_the_arm_is_said_to_be(on_device, device, tmp_path):
    device.device.axis.hold_arm(0.3)
    found = on_device("doctor", "--set-zero")
    assert found.exit_code == 0, found.output
    assert read_configuration(tmp_path / "bench.toml").drive.zero_rad == pytest.approx(0.3, abs=1e-3)
    again = json.loads(on_device("doctor", "--json").stdout)
    assert again["connection"]["sample"]["position_rad"] == pytest.approx(0.0, abs=1e-3)
    # at an end stop of a known angle
    found = on_device("doctor", "--set-zero", "--at-deg", "-90")
    assert found.exit_code == 0, found.output
    again = json.loads(on_device("doctor", "--json").stdout)
    assert again["connection"]["sample"]["position_rad"] == pytest.approx(-pi / 2.0, abs=1e-3)
