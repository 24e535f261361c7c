"""Imports: whole or not at all, in transactions that others can get between."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sqlalchemy import Connection

from bench.store import Event, Store
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.records import NewExperiment
from bench.store.tables import chain, trials
from bench.store.upkeep.importing import EVENT_BYTES, Import
from bench.store.upkeep.retention import remove
from compensator.lab.recordings.recording import Recording
from tests.queue.waiting import wait_for
from tests.store.examples import begin, begin_trial, rows


def recording(name: str, count: int = 10) -> Recording:
    channels = {"time_s": np.arange(float(count)), "duty": np.linspace(0.0, 1.0, count)}
    return Recording(name, "step", {"load_kg": 0.1}, channels, [Event(0.0, "begin", "")])


def begin_import(store: Store) -> Import:
    with store._database.writing():
        token = store.custody.token()
    return Import(store._database, token, NewExperiment("import", {}, {}, {}, "imported"))


def tables(store: Store) -> dict[str, int]:
    """How many rows each table has."""
    names = ("experiment", "trial", "trial_condition", "sample_block", "sample_overview", "event")
    with store._database.reading() as connection:
        return {name: connection.exec_driver_sql(f"SELECT count(*) FROM {name}").scalar_one() for name in names}


def test_nobody_sees_an_import_before_it_is_complete(store: Store, store_url: str) -> None:
    found = begin_import(store)
    found.add(recording("a"), "completed", "")
    with Store.open(store_url) as other:
        assert other.experiments() == other.trials() == []
        with pytest.raises(NotFoundError):
            other.experiment(found.experiment_id)
        with pytest.raises(NotFoundError):
            other.samples(1)
        found.add(recording("b"), "stopped", "stop was pressed")
        assert other.experiment(found.finish()).outcome == "completed"
        assert [(trial.outcome, trial.reason) for trial in other.trials()] == [
            ("completed", ""),
            ("stopped", "stop was pressed"),
        ]
        assert all(trial.finished_utc for trial in other.trials())


def test_a_bench_records_while_an_import_comes_in(store: Store) -> None:
    experiment_id = begin(store)
    writer = begin_trial(store, experiment_id)

    def recordings() -> Iterator[tuple[Recording, str, str]]:
        for name in "abc":
            writer.append(rows(writer.rows, 25))  # would wait for ever inside one transaction
            yield recording(name), "completed", ""

    store.add_imported("import", {}, {}, {}, recordings())
    assert store.trial(writer.trial_id).rows == 75
    assert len(store.trials()) == 4


def test_an_import_that_fails_leaves_no_row_in_any_table(store: Store) -> None:
    def recordings() -> Iterator[tuple[Recording, str, str]]:
        yield recording("a", 20_000), "completed", ""
        yield recording("a"), "completed", ""

    with pytest.raises(StoreValueError, match="has a trial 'a' already"):
        store.add_imported("import", {}, {}, {}, recordings())
    assert set(tables(store).values()) == {0}


@pytest.mark.parametrize("dies", ["closes", "was killed"])
def test_what_a_dead_import_left_is_removed_by_the_next_to_open(store_url: str, dies: str) -> None:
    store = Store.open(store_url)
    found = begin_import(store)
    found.add(recording("a", 20_000), "completed", "")
    if dies == "was killed":  # nothing of the store's own end happens
        assert store.custody._claim is not None
        store.custody._claim.release()
        store._database.close()
    else:
        store.close()

    def left_by_the_next() -> set[int]:
        with Store.open(store_url) as other:
            return set(tables(other).values())

    # a server notices some time later that a session is gone, and until then its claim lives
    wait_for(lambda: left_by_the_next() == {0}, timeout_s=10.0)
    with Store.open(store_url) as other:
        assert other.upkeep.check() == []


def test_an_import_of_a_living_process_is_left_alone(store: Store, store_url: str) -> None:
    found = begin_import(store)
    found.add(recording("a"), "completed", "")
    Store.open(store_url).close()
    found.finish()
    assert len(store.samples(store.trials()[0].id)["time_s"]) == 10


def test_no_trial_is_hashed_while_others_wait_to_write(
    store: Store, store_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain, hashed = chain.digest_of, []
    with Store.open(store_url, busy_timeout_s=0.2) as other:

        def while_another_writes(connection: Connection, subject: str, row_id: int, *more: Any) -> str | None:
            if subject == "trial":
                hashed.append(row_id)
                other.queue("bench").hold("a process that waits")  # would wait for the import in vain
            return plain(connection, subject, row_id, *more)

        monkeypatch.setattr(chain, "digest_of", while_another_writes)
        recordings = [(recording(name), "stopped", "stop was pressed") for name in "ab"]
        store.add_imported("import", {}, {}, {}, recordings)
    assert len(hashed) == 2
    monkeypatch.undo()
    assert store.upkeep.check() == []


def test_an_import_that_was_taken_for_dead_does_not_end_and_breaks_no_chain(store: Store) -> None:
    found = begin_import(store)
    found.add(recording("a"), "completed", "")
    remove(store._database, found.experiment_id)
    with pytest.raises(StoreStateError, match="removed by another process"):
        found.finish()
    assert set(tables(store).values()) == {0}
    assert store.upkeep.check() == []


def test_a_long_trial_comes_in_by_several_transactions(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bench.store.upkeep.importing.TRANSACTION_BYTES", 16 * 700)
    store.add_imported("import", {}, {}, {}, [(recording("a", 20_000), "completed", "")])
    (trial,) = store.trials()
    assert trial.rows == 20_000
    assert np.array_equal(store.samples(trial.id)["time_s"], np.arange(20_000.0))
    assert tables(store)["sample_block"] == -(-20_000 // 700)


def test_many_events_come_in_by_several_transactions(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bench.store.upkeep.importing.TRANSACTION_BYTES", 10 * EVENT_BYTES)
    plain, parts = trials.add_events, []
    monkeypatch.setattr(trials, "add_events", lambda *given: parts.append(len(given[2])) or plain(*given))
    events = [Event(float(number), "tick", str(number)) for number in range(25)]
    whole = recording("a")
    store.add_imported("import", {}, {}, {}, [(replace(whole, events=events), "completed", "")])
    assert store.events(store.trials()[0].id) == events
    assert parts == [10, 10, 5]
