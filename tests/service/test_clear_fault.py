"""A fault that the drive holds on to is cleared through the product, once a person has seen which it is."""

import json
import time

import pytest
import tomli_w

from bench.client import Bench
from bench.config.configuration import default_configuration, parse_configuration
from sim_backend.devices.modbus.serve import ModbusSettings, serve_modbus
from sim_backend.devices.side_channel_client import ask_once
from tests.cli.conftest import command  # noqa: F401  a fixture
from tests.queue.waiting import wait_for
from tests.service.running_service import TOKEN, running_service

FAULT = "over-current"


@pytest.fixture
def device():
    with serve_modbus(ModbusSettings(transport="tcp")) as running:
        yield running


@pytest.fixture
def fail(device):
    """Returns a function that makes a fault, of which nothing but the drive's memory is left."""

    def make(name=FAULT, duration_s=0.05):
        ask_once(device.side_channel, "fault", name=name, duration_s=duration_s)
        end_s = time.monotonic() + 5.0
        while device.device.report()["fault"] == "NONE":
            assert time.monotonic() < end_s
            time.sleep(0.01)
        time.sleep(2.0 * duration_s if duration_s < 1.0 else 0.0)

    return make


@pytest.fixture
def values(device):
    host, port = device.path.split(":")
    found = default_configuration().model_dump(mode="json", exclude_none=True)
    found["control"]["period_s"] = 0.02
    found["drive"] = {
        "kind": "modbus", "map": "friction-bench", "transport": "tcp", "host": host, "port": port,
        "side_channel": device.side_channel, "watchdog_s": 1.0, "answer_timeout_s": 0.3,
    }  # fmt: skip
    return found


@pytest.fixture
def on_device(command, values, tmp_path):  # noqa: F811
    (tmp_path / "bench.toml").write_text(tomli_w.dumps(values))
    return lambda *words: command("--config", "bench.toml", *words)


def test_the_command_shows_the_fault_and_clears_it_only_when_told(on_device, fail, device):
    fail()
    asked = on_device("drive", "clear-fault")
    assert asked.exit_code != 0
    assert FAULT in asked.output
    assert "then: friction-bench --config bench.toml drive clear-fault --yes" in " ".join(asked.output.split())
    assert device.device.report()["fault"] == "OVER_CURRENT"
    cleared = on_device("drive", "clear-fault", "--yes")
    assert cleared.exit_code == 0, cleared.output
    assert f"Cleared: {FAULT}. The power is off." in cleared.output
    assert device.device.report()["fault"] == "NONE"
    again = on_device("drive", "clear-fault", "--yes")
    assert (again.exit_code, "There is no fault to clear" in again.output) == (0, True)


def test_the_command_says_what_is_still_wrong(on_device, fail, device):
    fail(duration_s=60.0)
    found = on_device("drive", "clear-fault", "--yes")
    assert found.exit_code != 0
    assert f"cannot be cleared: {FAULT}; remove the cause" in found.output
    assert device.device.report()["fault"] == "OVER_CURRENT"


def test_the_state_for_programs(on_device, fail):
    fail()
    [found] = json.loads(on_device("drive", "state", "--json").stdout)
    assert (found["joint"], found["state"], found["fault"]) == ("joint", "fault", FAULT)


@pytest.fixture(params=[False, True], ids=["in the service", "in a process of its own"])
def service(request, values, tmp_path):
    configuration = parse_configuration(values, "bench.toml")
    with running_service(tmp_path, configuration=configuration, in_process_of_its_own=request.param) as running:
        yield running


def test_the_route_clears_what_was_shown_and_nothing_else(service, fail, device):
    fail()
    with Bench(service.url, TOKEN) as bench:
        assert bench.drive_state()["fault"] == FAULT
        refused = service.client.post("/drive/clear-fault", json={"fault": "under-voltage"})
        assert refused.status_code == 409
        assert "the fault is 'over-current' now, and 'under-voltage' was shown; nothing was" in refused.json()["detail"]
        assert device.device.report()["fault"] == "OVER_CURRENT"
        after = bench.clear_fault(FAULT)
    assert (after["fault"], after["drives"][0]["state"]) == ("", "disabled")
    assert device.device.report()["fault"] == "NONE"
    wait_for(lambda: f"cleared the fault '{FAULT}'" in service.client.get("/audit").text)  # a thread writes it


def test_who_may_not_operate_clears_nothing(service, fail, device):
    fail()
    body = {"fault": FAULT}
    assert service.stranger.post("/drive/clear-fault", json=body).status_code == 401
    with service.with_token("vera", "viewer") as viewer:
        assert viewer.post("/drive/clear-fault", json=body).status_code == 403
    with service.with_token("ada", "operator") as ada, service.with_token("bob", "operator") as bob:
        assert ada.post("/lease", json={"duration_s": 60}).status_code == 201
        assert bob.post("/drive/clear-fault", json=body).status_code == 409
        assert device.device.report()["fault"] == "OVER_CURRENT"
        assert ada.post("/drive/clear-fault", json=body).status_code == 200
    assert device.device.report()["fault"] == "NONE"


def test_a_cause_that_is_still_there(service, fail):
    fail(duration_s=60.0)
    found = service.client.post("/drive/clear-fault", json={"fault": FAULT})
    assert found.status_code == 502
    assert f"cannot be cleared: {FAULT}" in found.json()["detail"]


def test_not_while_an_experiment_runs(service, device):
    service.start("commissioning", pace="real-time")
    assert service.client.post("/drive/state").status_code == 409
    service.runner.stop()
    assert service.runner.wait(60.0)
