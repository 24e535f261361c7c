"""Ends that the database did not take: they are written at the next possibility."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from bench.store import Store
from bench.store.errors import StoreFullError, StoreLockedError
from tests.store.examples import begin, begin_trial, rows

REASON = "trial 'step 1': the disk is full"


@pytest.fixture
def backend() -> str:
    return "sqlite"


def break_finish(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise StoreFullError("store: the disk is full")

    monkeypatch.setattr("bench.store.tables.experiments.finish", full)


def test_an_end_on_a_full_disk_is_known_at_once_and_written_later(
    store_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store.open(store_url) as store:
        experiment_id = begin(store)
        writer = begin_trial(store, experiment_id)
        writer.append(rows(0, 10))
        with monkeypatch.context() as broken:
            break_finish(store, broken)
            with pytest.raises(StoreFullError):
                store.finish_experiment(experiment_id, "failed", REASON)
            found = store.experiment(experiment_id)
            assert (found.outcome, found.reason) == ("failed", REASON)
            assert store.trial(writer.trial_id).reason == REASON
            assert store.experiments()[0].outcome == store.trials()[0].outcome == "failed"
        begin(store)  # there is room again
        with Store.open(store_url) as other:
            assert other.experiment(experiment_id).reason == REASON


@pytest.mark.parametrize("dies", [False, True])
def test_the_next_to_open_the_store_writes_it(store_url: str, monkeypatch: pytest.MonkeyPatch, dies: bool) -> None:
    store = Store.open(store_url)
    experiment_id = begin(store)
    trial_id = begin_trial(store, experiment_id).trial_id
    with monkeypatch.context() as broken:
        break_finish(store, broken)
        with pytest.raises(StoreFullError):
            store.finish_experiment(experiment_id, "failed", REASON)
        if dies:
            assert store.custody._claim is not None
            store.custody._claim._file.close()  # type: ignore[attr-defined]  # as the operating system does
            store._database.close()
        else:
            store.close()
    with Store.open(store_url) as other:
        found = other.experiment(experiment_id)
        assert (found.outcome, found.reason) == ("failed", REASON)
        assert other.trial(trial_id).reason == REASON
    assert list(Path(store_url.removeprefix("sqlite:///")).parent.glob("*-owner-*")) == []


def test_an_end_under_a_lock_of_another_program_is_written_after_it(store_url: str) -> None:
    with Store.open(store_url, busy_timeout_s=0.2) as store:
        experiment_id = begin(store)
        with closing(sqlite3.connect(store_url.removeprefix("sqlite:///"))) as other:
            other.execute("BEGIN IMMEDIATE")
            with pytest.raises(StoreLockedError):
                store.finish_experiment(experiment_id, "tripped", "current is 2.1 A; allowed is at most 2 A")
            other.rollback()
    with Store.open(store_url) as again:
        assert again.experiment(experiment_id).outcome == "tripped"


def test_a_note_that_was_cut_off_counts_as_none(store_url: str) -> None:
    store = Store.open(store_url)
    experiment_id = begin(store)
    claim = store.custody._claim
    assert claim is not None
    claim.note({experiment_id: ("failed", REASON)})
    path = claim._path  # type: ignore[attr-defined]
    claim._file.close()  # type: ignore[attr-defined]
    path.write_text(path.read_text()[:20])
    store._database.close()
    with Store.open(store_url) as other:
        assert other.experiment(experiment_id).outcome == "interrupted"
