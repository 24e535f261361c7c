"""The benches of a laboratory, as a service lists them; and its link, lost and back."""

from pathlib import Path

from bench.config.configuration import default_configuration
from bench.runs.lab_link import LabLink
from bench.store import Store
from bench.store.tables.benches import BenchWord
from tests.queue.waiting import wait_for
from tests.service.running_service import RunningService


def test_a_bench_by_itself_lists_itself(service: RunningService) -> None:
    found = service.client.get("/benches").json()
    (bench,) = found["benches"]
    assert (found["where"], found["problem"], found["waiting"]) == ("", "", 0)
    assert (bench["name"], bench["state"], bench["lease"]) == (default_configuration().name, "idle", "")
    service.client.post("/lease", json={"duration_s": 60, "holder": "Ada"})
    assert "Ada" in service.client.get("/benches").json()["benches"][0]["lease"]
    service.client.delete("/lease")


def test_a_link_that_is_lost_says_so_and_hands_in_when_it_is_back(tmp_path: Path) -> None:
    folder = tmp_path / "not there yet"
    with Store.open(f"sqlite:///{tmp_path / 'own.sqlite'}") as own:
        link = LabLink(
            own, f"sqlite:///{folder / 'lab.sqlite'}", lambda n: BenchWord("gear", "pc", "idle", waiting=n), 0.01
        )
        experiment = own.begin_experiment("steps", {}, "simulated", {}, {"name": "paper"})
        own.finish_experiment(experiment, "completed")
        link.start()
        wait_for(lambda: "does not exist" in link.state.problem)
        folder.mkdir()
        wait_for(lambda: not link.state.problem and link.state.waiting == 0)
        with Store.open(f"sqlite:///{folder / 'lab.sqlite'}") as lab:
            assert [one.kind for one in lab.experiments()] == ["steps"]
        assert [one.word.name for one in link.state.benches] == ["gear"]
        link.close()
