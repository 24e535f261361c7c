"""Experiments: what is kept, how they end, how they are found."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from bench.store import Store
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from tests.store.examples import begin, begin_trial, rows


def test_an_experiment_is_kept_as_it_was_begun(store: Store, store_url: str) -> None:
    experiment_id = begin(store)
    store.finish_experiment(experiment_id, "completed", "all steps made", {"spread_a": np.float64(0.75)})
    with Store.open(store_url) as other:
        found = other.experiment(experiment_id)
    assert (found.kind, found.source, found.operator, found.note) == ("steps", "simulated", "Ada", "first")
    assert (found.parameters, found.provenance, found.rig) == ({"count": 3}, {"seed": 1}, {"name": "paper"})
    assert (found.outcome, found.reason, found.results) == ("completed", "all steps made", {"spread_a": 0.75})


def test_times_are_utc_with_zone(store: Store) -> None:
    experiment_id = begin(store)
    store.finish_experiment(experiment_id, "completed")
    found = store.experiment(experiment_id)
    assert found.finished_utc is not None
    assert found.started_utc.utcoffset() == found.finished_utc.utcoffset() == timedelta(0)
    assert found.started_utc <= found.finished_utc <= datetime.now(UTC)


def test_what_is_not_a_number_is_kept_as_null(store: Store) -> None:
    experiment_id = begin(store)
    store.finish_experiment(experiment_id, "completed", "", {"error_g": float("nan"), "loads_kg": np.array([0.0, 0.1])})
    assert store.experiment(experiment_id).results == {"error_g": None, "loads_kg": [0.0, 0.1]}


def test_a_result_that_is_no_json_is_refused_and_the_experiment_stays_open(store: Store) -> None:
    experiment_id = begin(store)
    with pytest.raises(StoreValueError, match="object cannot be kept as JSON"):
        store.finish_experiment(experiment_id, "completed", "", {"what": object()})
    assert store.experiment(experiment_id).outcome == "running"


def test_an_experiment_ends_once(store: Store) -> None:
    experiment_id = begin(store)
    store.finish_experiment(experiment_id, "refused", "8 rad/s is above the limit")
    with pytest.raises(StoreStateError, match="finished already"):
        store.finish_experiment(experiment_id, "completed")
    assert store.experiment(experiment_id).reason == "8 rad/s is above the limit"


@pytest.mark.parametrize("outcome", ["running", "done", ""])
def test_an_outcome_that_ends_nothing_is_refused(store: Store, outcome: str) -> None:
    with pytest.raises(StoreValueError, match="wanted completed"):
        store.finish_experiment(begin(store), outcome)


def test_a_source_that_does_not_exist_is_refused(store: Store) -> None:
    with pytest.raises(StoreValueError, match="wanted simulated, real, imported"):
        begin(store, source="guessed")


def test_a_trial_that_still_runs_ends_with_its_experiment(store: Store) -> None:
    experiment_id = begin(store)
    done, open_ = begin_trial(store, experiment_id, "a"), begin_trial(store, experiment_id, "b")
    done.finish("completed")
    open_.append(rows(0, 5))
    store.finish_experiment(experiment_id, "tripped", "current is 2.1 A; allowed is at most 2 A")
    assert store.trial(done.trial_id).outcome == "completed"
    found = store.trial(open_.trial_id)
    assert (found.outcome, found.reason, found.rows) == ("tripped", "current is 2.1 A; allowed is at most 2 A", 5)


def test_experiments_are_listed_newest_first_and_filtered(store: Store) -> None:
    ids = [begin(store, kind, source) for kind in ("steps", "load-sweep") for source in ("simulated", "real")]
    store.finish_experiment(ids[0], "completed")
    assert [found.id for found in store.experiments()] == ids[::-1]
    assert [found.id for found in store.experiments(kind="steps")] == [ids[1], ids[0]]
    assert [found.id for found in store.experiments(kind="steps", source="real")] == [ids[1]]
    assert [found.id for found in store.experiments(outcome="completed")] == [ids[0]]
    assert [found.id for found in store.experiments(limit=2, offset=1)] == [ids[2], ids[1]]


def test_an_experiment_that_is_not_there_is_named(store: Store) -> None:
    with pytest.raises(NotFoundError, match="experiment 7 is not in the store"):
        store.experiment(7)
    with pytest.raises(NotFoundError, match="experiment 7"):
        begin_trial(store, 7)
