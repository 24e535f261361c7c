"""How far a computation has come, over REST: by its record and by its stream."""

import json
import threading

import pytest

from bench.service.lab import Asker, LabProcesses
from bench.service.live.jobs import Jobs
from bench.store import Store
from compensator.lab import progress
from compensator.lab.diagnosis.four_families import STAGES
from compensator.lab.progress import Stage
from tests.service.recorded_joint import study_path


@pytest.fixture(scope="module")
def path(service) -> str:
    return study_path(service, "followed")


def test_a_diagnosis_is_followed_through_its_stages(service, path):
    told = []

    def listen() -> None:
        with service.stranger.stream("GET", "/live/jobs/b7/stream", timeout=120) as stream:
            told.extend(json.loads(line[6:]) for line in stream.iter_lines() if line.startswith("data: "))

    listener = threading.Thread(target=listen)
    listener.start()
    service.stranger.get(f"{path}/diagnose", headers={"X-Job": "b7"}, timeout=120).raise_for_status()
    listener.join(60)
    assert not listener.is_alive()
    assert told[-1]["state"] == "ended"
    assert {one["stage"] for one in told} & set(STAGES)
    shares = [one["share"] for one in told]
    assert shares[-1] == 1.0
    record = service.stranger.get("/live/jobs/b7").json()
    assert record["what"] == "diagnose"
    assert record["stages_done"] == record["stages"] == len(STAGES)


def test_a_job_that_is_none_is_said(service):
    answer = service.stranger.get("/live/jobs/none")
    assert answer.status_code == 404
    assert "X-Job" in answer.json()["detail"]


def test_what_is_left_follows_from_the_last_time():
    jobs, names = Jobs(), ("one", "two")
    first = jobs.begin("a", "diagnose")
    first.tell(Stage(names, 0))
    assert first.record().left_s is None, "nothing is known the first time"
    first.tell(Stage(names, 1))
    first.tell(Stage(names, 2))
    first.end()
    second = jobs.begin("b", "diagnose")
    assert second.record().state == "waiting"
    second.tell(Stage(names, 0))
    assert second.record().left_s is not None
    assert jobs.find("a") is first


def test_a_process_of_the_lab_tells_its_stages(tmp_path):
    url = f"sqlite:///{tmp_path / 'bench.sqlite'}"
    told: list[Stage] = []
    with Store.open(url):
        lab = LabProcesses(url)
        assert lab.call_for(Asker(told.append), counting) == 2
        lab.close()
    assert [(one.name, one.done) for one in told] == [("one", 0), ("two", 1), ("", 2)]


def counting(_store: Store) -> int:
    """What a lab's process computes."""
    with progress.stages(["one", "two"]):
        progress.enter("two")
        return 2
