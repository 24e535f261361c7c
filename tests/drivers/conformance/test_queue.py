"""The queue and a campaign over the wire: every kind of experiment that has no conformance test of its own, once and
short, over REST, with a person who hangs what is asked for. The device is a process of its own.
"""

from collections.abc import Iterator

import pytest

from tests.drivers.conformance.benches import BENCHES, PATIENT
from tests.drivers.conformance.campaign import Person
from tests.queue.waiting import wait_for
from tests.service.running_service import RunningService, running_service

WAVEFORM = "time_s,position_rad\n0,0\n0.5,0.1\n1,0\n"
SHORT = {
    "commissioning": {},
    "breakaway-ramps": {"rates_a_s": [1.0], "dwells_s": [0.2]},
    "reversals": {"amplitudes_rad": [0.2], "strokes": 2},
    "chirp": {"duration_s": 2.0, "high_hz": 2.0},
    "multisine": {"tones": 3, "low_hz": 1.0, "high_hz": 3.0, "wave_s": 1.0, "waves": 1},
    "coast-down": {"speeds_rad_s": [2.0], "coast_s": 1.0},
    "hold-and-soak": {
        "load_kg": 0.0,
        "hold_rad": 0.5,
        "soak_s": 1.5,
        "probe_every_s": 1.0,
        "probe_rad": 0.2,
        "probe_rad_s": 1.0,
    },
    "waveform": {"csv": WAVEFORM},
}
CAMPAIGN = {
    "name": "loads over the wire",
    "kind": "reversals",
    "parameters": {"amplitudes_rad": [0.2], "strokes": 2},
    "grid": {"load_kg": [0.0, 0.05]},
}
pytestmark = [pytest.mark.timeout(400), pytest.mark.alone]


@pytest.fixture
def service(name, tmp_path) -> Iterator[RunningService]:
    with (
        BENCHES[name](*PATIENT) as bench,
        running_service(tmp_path, configuration=bench.configuration, in_process_of_its_own=True) as running,
    ):
        person = Person(bench, running.runner)
        yield running
        person.leave()


def in_queue(service: RunningService) -> dict:
    return service.stranger.get("/queue", params={"ended": 100}).json()


@pytest.mark.parametrize("name", ["modbus-tcp", "canopen"])
def test_every_kind_runs_from_the_queue_and_a_campaign_after_it(service, name):
    items = [{"kind": kind, "parameters": SHORT[kind]} for kind in SHORT]
    assert service.client.post("/queue", json={"items": items}).status_code == 201
    assert service.client.post("/campaigns", json=CAMPAIGN).status_code == 201
    wait_for(lambda: in_queue(service)["state"] in ("idle", "held"), 300.0)
    found = in_queue(service)
    assert found["state"] == "idle", found["reason"]
    ended = list(reversed(found["ended"]))
    assert [one["kind"] for one in ended] == [*SHORT, "reversals", "reversals"]
    assert {one["state"] for one in ended} == {"completed"}
    for one in ended[1:]:
        [trial, *_] = service.store.trials(one["experiment_id"])
        assert trial.rows > 20
        assert trial.outcome == "completed"
    assert service.store.experiment(ended[-1]["experiment_id"]).provenance["drive"]["product"]
