"""Benches that take work from a laboratory: each item is run once, by a bench that may, and STOP holds it there."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from bench.config.configuration import default_configuration
from bench.runs.lab_work import TAKEN_OUT, LabWork
from bench.runs.lease import Lease
from bench.runs.queue.conductor import Conductor
from bench.runs.runner import Runner
from bench.store import Store
from bench.store.errors import StoreUnreachableError
from bench.store.tables import lab_queue
from bench.store.tables.lab_queue import NewLabItem
from bench.store.tables.queue import NewItem
from tests.queue.waiting import wait_for

STEPS = NewLabItem("steps", {"repeats": 1}, pace="fast", operator="Ada", tags=["winter"])
SLOW = NewLabItem("steps", {"repeats": 3}, pace="real-time")


@dataclass
class TakingBench:
    """A bench as a service wires it: store, runner, lease, queue, and what it has of the laboratory's."""

    name: str
    folder: Path
    takes: bool = True
    tags: tuple[str, ...] = ()
    stack: ExitStack = field(default_factory=ExitStack)

    def __post_init__(self) -> None:
        plain = default_configuration()
        places = plain.store.model_copy(update={"lab_queue": self.takes, "lab_tags": self.tags})
        configuration = plain.model_copy(update={"name": self.name, "store": places})
        self.store = self.stack.enter_context(Store.open(f"sqlite:///{self.folder / self.name}.sqlite"))
        self.runner = Runner(configuration, self.store)
        self.stack.callback(self.runner.close)
        self.lease = Lease(lambda: self.runner.status().experiment_id if self.runs else None)
        self.conductor = Conductor(self.runner, self.store, self.lease.starting)
        self.stack.callback(self.conductor.close)
        self.work = LabWork(configuration, self.conductor, self.is_free)
        self.conductor.begin()

    @property
    def runs(self) -> bool:
        return self.runner.status().outcome == "running"

    def is_free(self) -> bool:
        return not (self.runs or self.conductor.held or self.lease.current())

    def stop(self, reason: str) -> None:
        self.conductor.stop(reason)
        self.runner.stop(reason)

    def close(self) -> None:
        self.conductor.end()
        self.runner.stop("the test has ended")
        self.stack.close()


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Store]:
    with Store.open(f"sqlite:///{tmp_path / 'lab.sqlite'}") as opened:
        yield opened


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Callable[..., TakingBench]]:
    made: list[TakingBench] = []

    def make(name: str = "bench 1", **options: object) -> TakingBench:
        made.append(TakingBench(name, tmp_path, **options))
        return made[-1]

    yield make
    for one in made:
        one.close()


def looks(lab: Store, *benches: TakingBench) -> None:
    for one in benches:
        one.work.look(lab)


def until_done(lab: Store, *benches: TakingBench) -> None:
    def done() -> bool:
        looks(lab, *benches)
        return not lab.lab_queue.items("waiting", "taken", "running")

    wait_for(done)


def states(lab: Store) -> list[tuple[str, str]]:
    return [(one.state, one.bench) for one in lab.lab_queue.items()]


def test_two_benches_share_the_work_and_nothing_is_run_twice(lab, bench):
    one, two = bench("bench 1"), bench("bench 2", tags=("warm",))
    lab.lab_queue.add([STEPS] * 4 + [NewLabItem("steps", {"repeats": 1}, pace="fast", for_tags=["warm"])])
    until_done(lab, one, two)
    found = lab.lab_queue.items()
    assert [item.state for item in found] == ["completed"] * 5
    assert found[-1].bench == "bench 2"
    assert {item.bench for item in found} == {"bench 1", "bench 2"}
    ran = {each.name: [experiment.id for experiment in each.store.experiments()] for each in (one, two)}
    assert sum(map(len, ran.values())) == 5
    assert all(item.origin_id in ran[item.bench] for item in found)
    kept = one.store.experiment(ran["bench 1"][0])
    assert (kept.operator, kept.tags) == ("Ada", ("winter",))


def test_a_bench_whose_owner_said_nothing_takes_nothing(lab, bench):
    silent = bench(takes=False)
    lab.lab_queue.add([STEPS])
    for _ in range(3):
        looks(lab, silent)
    assert states(lab) == [("waiting", "")]
    assert silent.conductor.table.items() == []
    assert default_configuration().store.lab_queue is False


def test_its_own_limits_decide(lab, bench):
    one = bench()
    lab.lab_queue.add([NewLabItem("steps", {"load_kg": 5.0}), STEPS])
    looks(lab, one)
    first, second = lab.lab_queue.items()
    assert (first.state, second.bench) == ("waiting", "bench 1")
    assert "load_kg is 5 kg; allowed is at most" in first.declined["bench 1"]
    wait_for(lambda: one.store.experiments())


def test_while_it_runs_the_bench_is_the_laboratorys(lab, bench):
    one = bench()
    lab.lab_queue.add([SLOW])
    looks(lab, one)
    wait_for(lambda: len(one.runner.live().rows) > 20)
    holder = one.lease.current()
    assert holder is not None
    assert holder.holder == "the laboratory's queue"
    looks(lab, one)
    assert states(lab) == [("running", "bench 1")]
    one.stop("cable is caught")
    until_done(lab, one)
    (item,) = lab.lab_queue.items()
    assert (item.state, item.reason) == ("stopped", "trial 'step-001': cable is caught")
    lab.lab_queue.add([STEPS])
    looks(lab, one)
    assert states(lab)[-1] == ("waiting", "")  # STOP holds: nothing more is taken until somebody resumes
    one.conductor.resume()
    until_done(lab, one)


def test_whoever_has_the_bench_has_it_alone(lab, bench):
    one = bench()
    one.lease.take("Grace", "", 60.0)
    lab.lab_queue.add([STEPS])
    looks(lab, one)
    assert states(lab) == [("waiting", "")]
    one.lease.release("Grace")
    until_done(lab, one)


def test_what_waits_at_a_bench_that_is_held_goes_to_another(lab, bench, monkeypatch):
    one = bench()
    monkeypatch.setattr(one.conductor, "confirm", lambda _claim: one.conductor.stop("coffee") or True)
    lab.lab_queue.add([STEPS])
    looks(lab, one)
    wait_for(lambda: one.conductor.held)
    looks(lab, one)
    assert states(lab) == [("waiting", "")]
    assert (one.conductor.table.items(), one.store.experiments()) == ([], [])
    two = bench("bench 2")
    until_done(lab, one, two)
    assert states(lab) == [("completed", "bench 2")]


def test_without_a_sure_word_of_the_laboratory_nothing_starts(lab, bench, monkeypatch):
    """The link is cut while it says that the item may begin: nobody knows whether the laboratory took note."""
    one, plain, cut = bench(), lab_queue.LabQueueTable.begin, []

    def cutting(table: lab_queue.LabQueueTable, claim: str) -> bool:
        plain(table, claim)
        cut.append(claim)
        if len(cut) == 1:
            raise StoreUnreachableError("the link is cut")
        return True

    monkeypatch.setattr(lab_queue.LabQueueTable, "begin", cutting)
    lab.lab_queue.add([STEPS])
    looks(lab, one)
    wait_for(lambda: cut and not one.conductor.table.items())
    assert one.store.experiments() == []
    assert states(lab) == [("running", "bench 1")]
    until_done(lab, one)
    assert (len(one.store.experiments()), states(lab)) == (1, [("completed", "bench 1")])
    assert lab.lab_queue.items()[0].declined == {}


def test_an_item_that_another_bench_was_given_meanwhile_does_not_start(lab, bench, monkeypatch):
    one, two = bench("bench 1"), bench("bench 2")
    asked, go_on = threading.Event(), threading.Event()
    plain = one.conductor.confirm

    def slowly(claim: str) -> bool:
        asked.set()
        assert go_on.wait(30.0)
        return plain(claim)

    monkeypatch.setattr(one.conductor, "confirm", slowly)
    lab.lab_queue.add([STEPS])
    looks(lab, one)
    assert asked.wait(30.0)
    monkeypatch.setattr(lab_queue, "LOST_S", -1.0)
    looks(lab, two)
    monkeypatch.setattr(lab_queue, "LOST_S", 20.0)
    go_on.set()
    until_done(lab, one, two)
    wait_for(lambda: not one.conductor.table.items())
    assert (one.store.experiments(), states(lab)) == ([], [("completed", "bench 2")])


def test_what_somebody_takes_out_at_the_bench_goes_to_another(lab, bench, monkeypatch):
    one, taken = bench(), threading.Event()
    monkeypatch.setattr(one.conductor, "_begin", lambda _item: taken.wait(0.05) and False)
    lab.lab_queue.add([STEPS])
    looks(lab, one)
    (own,) = one.conductor.table.items()
    one.conductor.table.remove(own.id)
    looks(lab, one)
    looks(lab, one)
    assert lab.lab_queue.items("waiting")[0].declined == {"bench 1": TAKEN_OUT}
    assert one.conductor.table.items() == []


def test_a_bench_that_was_killed_says_what_became_of_what_it_had(lab, bench, tmp_path):
    one = bench()
    lab.lab_queue.add([STEPS, STEPS])
    # as a process leaves it that is killed: one taken and in its queue, one begun
    for begun in (False, True):
        item = lab.lab_queue.take(one.work._taker)
        table = one.store.queue("bench 1")
        [own] = table.add([NewItem("steps", {"repeats": 1}, pace="fast", lab_claim=item.claim)])
        if begun:
            assert lab.lab_queue.begin(item.claim)
            table.begin(own)
    one.close()
    again = TakingBench("bench 1", tmp_path)
    try:
        assert again.conductor.held  # something was left: somebody looks at the bench first
        looks(lab, again)
        assert states(lab) == [("waiting", ""), ("interrupted", "bench 1")]
        assert again.conductor.table.items("waiting") == []
        looks(lab, again)
        assert states(lab)[0] == ("waiting", "")
        again.conductor.resume()
        until_done(lab, again)
        assert (len(again.store.experiments()), states(lab)[0]) == (1, ("completed", "bench 1"))
    finally:
        again.close()


def test_what_is_asked_here_comes_first(lab, bench):
    one = bench()
    lab.lab_queue.add([SLOW])
    one.conductor.add([NewItem("steps", {"repeats": 1}, pace="fast")])
    looks(lab, one)
    wait_for(lambda: one.store.experiments())
    time.sleep(0.05)
    until_first = one.store.experiments()[-1]
    assert until_first.parameters["repeats"] == 1
