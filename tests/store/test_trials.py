"""Trials: conditions, samples, events, and how they are found."""

import numpy as np
import pytest

from bench.store import Event, Store
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.tables.samples import BLOCK_ROWS
from tests.store.examples import CHANNELS, begin, begin_trial, rows


def test_samples_come_back_bit_for_bit(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    odd = np.array([[0.1, -0.0, np.inf], [5e-324, np.nan, -1e308]])
    parts = [rows(0, 3), odd, rows(3, 1)]
    for part in parts:
        writer.append(part)
    found = store.samples(writer.trial_id)
    assert list(found) == list(CHANNELS)
    assert np.column_stack(list(found.values())).tobytes() == np.concatenate(parts).tobytes()


def test_rows_longer_than_a_block_come_back_in_order(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    writer.append(rows(0, 10))
    writer.append(rows(10, 2 * BLOCK_ROWS + 7))
    found = store.samples(writer.trial_id, ["position_rad"])
    assert list(found) == ["position_rad"]
    assert np.array_equal(found["position_rad"], -np.arange(2.0 * BLOCK_ROWS + 17))


def test_a_view_with_strides_is_stored_as_it_looks(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    wide = np.arange(30.0).reshape(5, 6)
    writer.append(wide[::2, ::2])
    found = store.samples(writer.trial_id)
    assert np.array_equal(np.column_stack(list(found.values())), wide[::2, ::2])


def test_what_is_appended_is_there_at_once_for_others(store: Store, store_url: str) -> None:
    writer = begin_trial(store, begin(store))
    with Store.open(store_url) as other:
        for total in range(10, 50, 10):
            writer.append(rows(total - 10, 10))
            assert other.trial(writer.trial_id).rows == total == len(other.samples(writer.trial_id)["time_s"])


def test_a_trial_without_rows_has_empty_samples(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    writer.append(np.empty((0, 3)))
    assert {name: values.shape for name, values in store.samples(writer.trial_id).items()} == dict.fromkeys(
        CHANNELS, (0,)
    )
    assert store.samples_reduced(writer.trial_id, None, 10)["time_s"].shape == (0,)


@pytest.mark.parametrize("shape", [(3,), (2, 4), (2, 3, 1)])
def test_rows_of_another_shape_are_refused(store: Store, shape: tuple[int, ...]) -> None:
    writer = begin_trial(store, begin(store))
    with pytest.raises(StoreValueError, match="one per channel"):
        writer.append(np.zeros(shape))
    assert store.trial(writer.trial_id).rows == 0


def test_nothing_follows_the_end_of_a_trial(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    writer.finish("stopped", "stop was pressed", {"spread_a": 0.1})
    for call in (lambda: writer.append(rows(0, 1)), lambda: writer.finish("completed")):
        with pytest.raises(StoreStateError, match="is finished"):
            call()
    found = store.trial(writer.trial_id)
    assert (found.outcome, found.reason, found.results) == ("stopped", "stop was pressed", {"spread_a": 0.1})
    assert found.finished_utc is not None


def test_a_finished_experiment_takes_no_more_trials(store: Store) -> None:
    experiment_id = begin(store)
    store.finish_experiment(experiment_id, "stopped")
    with pytest.raises(StoreStateError, match="begin a new one"):
        begin_trial(store, experiment_id)


def test_conditions_keep_type_and_order(store: Store) -> None:
    conditions = {"load_kg": 0.1, "balanced": False, "grease": "NLGI 2", "repeat": 3, "empty": "", "zero": 0.0}
    trial_id = begin_trial(store, begin(store), **conditions).trial_id
    found = store.trial(trial_id).conditions
    assert found == conditions
    assert list(found) == list(conditions)
    assert [type(value) for value in found.values()] == [float, bool, str, float, str, float]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), None, [1.0]])
def test_a_condition_that_says_nothing_is_refused_and_no_trial_begins(store: Store, value: object) -> None:
    experiment_id = begin(store)
    with pytest.raises(StoreValueError, match="condition 'load_kg'"):
        begin_trial(store, experiment_id, load_kg=value)  # type: ignore[arg-type]
    assert store.trials(experiment_id) == []


def test_a_name_is_given_once_in_an_experiment(store: Store) -> None:
    first, second = begin(store), begin(store)
    begin_trial(store, first, "a")
    begin_trial(store, second, "a")
    with pytest.raises(StoreValueError, match="has a trial 'a' already"):
        begin_trial(store, first, "a")


@pytest.mark.parametrize("channels", [(), ("position_rad",), ("time_s", "angle"), ("time_s", "duty", "duty")])
def test_channels_that_nobody_knows_are_refused(store: Store, channels: tuple[str, ...]) -> None:
    with pytest.raises(StoreValueError, match="wanted time_s and any of"):
        store.begin_trial(begin(store), "a", "step", {}, channels)


def test_a_channel_that_the_trial_has_not_is_named(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    with pytest.raises(NotFoundError, match="no channel 'current_a'; it has time_s, position_rad, duty"):
        store.samples(writer.trial_id, ["current_a"])


def test_trials_are_found_by_what_they_are(store: Store) -> None:
    first, second = begin(store, source="simulated"), begin(store, source="real")
    a = begin_trial(store, first, "a", load_kg=0.0, balanced=True)
    b = begin_trial(store, first, "b", load_kg=0.05, balanced=False, grease="NLGI 2")
    c = begin_trial(store, second, "c", load_kg=0.1, balanced=False)
    b.finish("completed")

    def found(**wanted: object) -> list[str]:
        return [trial.name for trial in store.trials(**wanted)]  # type: ignore[arg-type]

    assert found() == ["a", "b", "c"]
    assert found(experiment_id=first) == ["a", "b"]
    assert found(source="real") == ["c"]
    assert found(outcome="completed") == ["b"]
    assert found(kind="none") == []
    assert found(conditions={"load_kg": 0.0}) == ["a"]
    assert found(conditions={"load_kg": (0.05, 0.1)}) == ["b", "c"]
    assert found(conditions={"load_kg": (0.01, 1.0), "balanced": False, "grease": "NLGI 2"}) == ["b"]
    assert found(conditions={"balanced": 1.0}) == []
    assert found(limit=1, offset=1) == ["b"]
    assert [trial.id for trial in store.trials()] == [a.trial_id, b.trial_id, c.trial_id]


def test_long_lists_carry_their_conditions(store: Store) -> None:
    experiment_id = begin(store)
    for repeat in range(600):
        begin_trial(store, experiment_id, f"{repeat}", repeat=repeat)
    found = store.trials()
    assert [trial.conditions["repeat"] for trial in found] == list(range(600))
    assert store.trials_of([trial.id for trial in found[::-1]]) == found[::-1]


def test_events_are_in_order_of_time(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    writer.append(rows(0, 2), [Event(2.0, "breakaway", "up"), Event(1.0, "settled")])
    writer.append(rows(0, 0), [Event(2.0, "breakaway", "down")])
    assert store.events(writer.trial_id) == [
        Event(1.0, "settled", ""),
        Event(2.0, "breakaway", "up"),
        Event(2.0, "breakaway", "down"),
    ]


def test_a_trial_that_is_not_there_is_named(store: Store) -> None:
    for call in (store.trial, store.samples, store.events):
        with pytest.raises(NotFoundError, match="trial 9 is not in the store"):
            call(9)
    with pytest.raises(NotFoundError, match="trial 9 is not in the store"):
        store.trials_of([begin_trial(store, begin(store)).trial_id, 9])


def test_a_text_with_a_nul_in_it_is_refused_and_nothing_is_kept(store: Store) -> None:
    experiment_id = begin(store)
    with pytest.raises(StoreValueError, match="NUL character"):
        begin_trial(store, experiment_id, grease="NLGI\0 2")
    assert store.trials(experiment_id) == []
