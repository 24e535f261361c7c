"""The laboratory's queue as services have it: asked for at one bench, taken by another, also where one is killed."""

from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
import tomli_w

from bench.config.configuration import BenchConfiguration, default_configuration
from bench.runs import lab_link
from bench.store import Store
from bench.store.tables.lab_queue import LabItem, NewLabItem
from tests.queue.waiting import wait_for
from tests.service.running_service import running_service
from tests.service.served_process import started_process

STEPS = {"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"}
LONG = NewLabItem("steps", {"repeats": 50}, pace="real-time")


@pytest.fixture(autouse=True)
def _often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lab_link.LabLink.__init__, "__defaults__", (0.1, False, None))


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Store]:
    with Store.open(f"sqlite:///{tmp_path / 'lab.sqlite'}") as opened:
        yield opened


def named(name: str, folder: Path, takes: bool) -> BenchConfiguration:
    """A simulated bench of the laboratory in a folder."""
    plain = default_configuration()
    places = {"lab_url": f"sqlite:///{folder / 'lab.sqlite'}", "lab_queue": takes}
    return plain.model_copy(update={"name": name, "store": plain.store.model_copy(update=places)})


def in_folder(folder: Path, name: str) -> Path:
    (folder / name).mkdir(exist_ok=True)
    return folder / name


def state_of(lab: Store, item_id: int) -> Callable[[], LabItem]:
    return lambda: next(item for item in lab.lab_queue.items() if item.id == item_id)


def test_what_is_asked_for_at_one_bench_is_run_by_another(lab, tmp_path):
    asking, taking = named("one", tmp_path, takes=False), named("two", tmp_path, takes=True)
    with running_service(in_folder(tmp_path, "one"), configuration=asking) as one:
        wait_for(lambda: one.client.get("/benches").json()["problem"] == "")
        body = {"items": [STEPS, STEPS | {"for_bench": "three", "tags": ["winter"]}]}
        answer = one.client.post("/benches/queue", json=body)
        assert answer.status_code == 201, answer.text
        first, second = answer.json()["item_ids"]
        wait_for(lambda: len(one.client.get("/benches").json()["queue"]) == 2)
        with running_service(in_folder(tmp_path, "two"), configuration=taking) as two:
            wait_for(lambda: state_of(lab, first)().state == "completed")
            (ran,) = two.client.get("/experiments").json()["items"]
            assert state_of(lab, first)().origin_id == ran["experiment_id"]
            wait_for(lambda: state_of(lab, first)().experiment_id is not None)  # handed in
            benches = {bench["name"]: bench for bench in one.client.get("/benches").json()["benches"]}
            assert "takes from the laboratory's" in benches["two"]["queue"]
            assert "takes" not in benches["one"]["queue"]
        wait_for(lambda: len(one.client.get("/benches").json()["queue"]) == 1)
        (left,) = one.client.get("/benches").json()["queue"]
        assert (left["item_id"], left["for_bench"], left["state"], left["tags"]) == (
            second,
            "three",
            "waiting",
            ["winter"],
        )
        assert one.stranger.delete(f"/benches/queue/{second}").status_code == 401
        assert one.client.delete(f"/benches/queue/{second}").status_code == 204
        assert one.client.delete(f"/benches/queue/{second}").status_code == 404
        assert one.client.delete(f"/benches/queue/{first}").status_code == 409


def test_unknown_kinds_and_a_bench_by_itself_are_refused(service):
    wrong = service.client.post("/benches/queue", json={"items": [{"kind": "magic"}]})
    assert wrong.status_code == 404
    alone = service.client.post("/benches/queue", json={"items": [STEPS]})
    assert (alone.status_code, "set store.lab_url" in alone.json()["detail"]) == (422, True)


def test_what_a_killed_bench_had_begun_is_run_by_nobody_else(lab, tmp_path):
    [long] = lab.lab_queue.add([LONG])
    folder = in_folder(tmp_path, "one")
    values = named("one", tmp_path, takes=True).model_dump(mode="json", exclude_none=True)
    (folder / "bench.toml").write_text(tomli_w.dumps(values))
    options = ("--config", str(folder / "bench.toml"))
    with started_process(folder, *options) as (process, url):
        wait_for(lambda: state_of(lab, long)().state == "running")
        wait_for(lambda: httpx.get(f"{url}/api/v1/queue/1").json()["experiment_id"])
        process.kill()
        process.wait(30.0)
    [short] = lab.lab_queue.add([NewLabItem("steps", {"repeats": 1}, pace="fast")])
    with running_service(in_folder(tmp_path, "two"), configuration=named("two", tmp_path, takes=True)) as two:
        wait_for(lambda: state_of(lab, short)().state == "completed")
        assert state_of(lab, short)().bench == "two"
        assert (state_of(lab, long)().state, state_of(lab, long)().bench) == ("running", "one")
        assert [one["parameters"]["repeats"] for one in two.client.get("/experiments").json()["items"]] == [1]
    with started_process(folder, *options):
        wait_for(lambda: state_of(lab, long)().state not in ("running", "waiting", "taken"))
    ended = state_of(lab, long)()
    assert (ended.state, ended.bench) == ("stopped", "one")  # its control loop saw that the service was gone
    assert "is gone" in ended.reason
    assert len(lab.experiments()) == 2  # both handed in, each once
