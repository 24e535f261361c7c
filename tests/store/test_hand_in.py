"""What a bench recorded comes to the laboratory once, whatever happens to the link."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from bench.store import Store
from bench.store.database import Database
from bench.store.errors import StoreUnreachableError
from bench.store.tables.benches import BenchWord
from bench.store.upkeep import hand_in
from tests.store.examples import begin
from tests.store.link_cuts import compared
from tests.store.rates import CHANNELS


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Store]:
    with Store.open(f"sqlite:///{tmp_path / 'own.sqlite'}") as opened:
        yield opened


def record(bench: Store, blocks: int = 3) -> int:
    """An experiment with everything that one can have."""
    provenance = {"configuration": {"name": "bench 3"}}
    experiment = bench.begin_experiment("steps", {"repeats": 1}, "real", provenance, {"name": "paper"}, "Ada", "note")
    writer = bench.begin_trial(experiment, "a", "steps", {"load_kg": 0.1, "grease": "new"}, CHANNELS)
    for number in range(blocks):
        writer.append(np.full((700, len(CHANNELS)), number + 0.5), [(float(number), "breakaway", "up")])
    writer.finish("tripped", "too fast", {"current_a": 0.2})
    bench.annotate(experiment, tags=["winter"])
    bench.finish_experiment(experiment, "tripped", "too fast", {"spread_a": 0.1})
    return experiment


def test_all_of_an_experiment_comes_over_and_is_sound(bench: Store, store: Store) -> None:
    begin(store)  # so that numbers differ
    own = record(bench)
    there = bench.hand_in_to(store, "bench 3").hand_in(own)
    first, second = bench.experiment(own), store.experiment(there)
    for name in ("kind", "parameters", "source", "operator", "note", "provenance", "rig", "started_utc", "finished_utc",
                 "outcome", "reason", "results", "tags"):  # fmt: skip
        assert getattr(first, name) == getattr(second, name), name
    (mine,), (theirs,) = bench.trials(own), store.trials(there)
    assert (mine.conditions, mine.rows, mine.outcome, mine.results) == (
        theirs.conditions, theirs.rows, theirs.outcome, theirs.results)  # fmt: skip
    assert bench.events(mine.id) == store.events(theirs.id)
    assert compared(bench, store, "bench 3") == (0, 0)
    assert store.samples_reduced(theirs.id, None, 10).keys() == set(CHANNELS)
    assert store.upkeep.check() == []


def test_what_is_there_does_not_come_twice_and_not_again_after_its_removal(bench: Store, store: Store) -> None:
    hand = bench.hand_in_to(store, "bench 3")
    own = record(bench)
    assert hand.waiting() == [own]
    there = hand.hand_in(own)
    assert (hand.waiting(), hand.hand_in(own)) == ([], there)
    assert len(store.experiments()) == 1
    store.removal.experiment(there)
    assert (hand.waiting(), store.experiments()) == ([], [])


def test_what_runs_is_not_handed_in_and_two_benches_may_have_the_same_number(bench: Store, store: Store) -> None:
    begin(bench)
    assert bench.hand_in_to(store, "bench 3").waiting() == []
    own = record(bench)
    numbers = {bench.hand_in_to(store, name).hand_in(own) for name in ("bench 3", "bench 4")}
    assert len(numbers) == 2


def test_a_copy_that_broke_off_is_not_seen_and_goes_on(
    bench: Store, store: Store, store_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hand_in, "TRANSACTION_BYTES", 1)  # a block a time
    own = record(bench, blocks=5)
    recording, sent = Database.recording, []

    def breaking(database: Database) -> object:
        sent.append(1)
        if len(sent) == 3:
            raise StoreUnreachableError("the link is cut")
        return recording(database)

    monkeypatch.setattr(Database, "recording", breaking)
    with pytest.raises(StoreUnreachableError):
        bench.hand_in_to(store, "bench 3").hand_in(own)
    assert store.experiments() == []
    with Store.open(store_url) as other:  # whoever opens it leaves what is coming in alone
        assert other.experiments() == []
    bench.hand_in_to(store, "bench 3").hand_in(own)
    blocks = 5 + len(overviews(bench, own))
    assert len(sent) == blocks + 1  # none was sent again but the one that broke off
    assert compared(bench, store, "bench 3") == (0, 0)


def overviews(bench: Store, experiment_id: int) -> list[object]:
    """The rows of the overview of an experiment's trial."""
    (trial,) = bench.trials(experiment_id)
    with bench._database.reading() as connection:
        query = f"SELECT first_row FROM sample_overview WHERE trial_id = {trial.id}"
        return list(connection.exec_driver_sql(query))


def test_a_bench_that_is_silent_is_lost(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    store.benches.tell(BenchWord("bench 4", "pc", "idle"))
    store.benches.tell(BenchWord("bench 3", "pc", "idle"))
    store.benches.tell(BenchWord("bench 3", "pc", "running", "steps", "Ada for another 60 s", "", 2))
    first, second = store.benches.all()
    assert (first.word.name, first.state, first.word.waiting, second.state) == ("bench 3", "running", 2, "idle")
    assert abs(first.silent_s) < 5.0
    monkeypatch.setattr("bench.store.tables.benches.LOST_S", -1.0)
    assert first.state == "lost"


@pytest.mark.usefixtures("server")  # skipped where there is none
def test_links_that_are_cut_lose_and_double_nothing() -> None:
    # a process of its own: a cursor whose server is gone cannot be closed, and says so when it is collected
    command = [sys.executable, "-m", "tests.store.link_cuts", "--cuts", "6", "--seed", "3"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.endswith("rows lost 0, doubled 0\n")
