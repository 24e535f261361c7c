"""Fewer rows for a plot."""

import numpy as np
import pytest

from bench.store import Store
from bench.store.errors import StoreValueError
from bench.store.tables.plotted.window import rows_to_keep
from tests.store.examples import begin, begin_trial


def test_few_rows_are_all_kept() -> None:
    assert list(rows_to_keep({"duty": np.zeros(10)}, 10)) == list(range(10))


def test_a_spike_of_one_sample_is_kept() -> None:
    duty = np.sin(np.linspace(0, 20, 100_000))
    duty[[31_234, 77_001]] = [5.0, -5.0]
    kept = rows_to_keep({"duty": duty}, 500)
    assert len(kept) <= 502
    assert {0, 31_234, 77_001, 99_999} <= set(kept)
    assert np.all(np.diff(kept) > 0)


def test_every_channel_keeps_its_own_spike() -> None:
    channels = {name: np.zeros(50_000) for name in ("duty", "current_a")}
    channels["duty"][100] = channels["current_a"][40_000] = 1.0
    assert {100, 40_000} <= set(rows_to_keep(channels, 50))


def test_unknown_samples_hide_no_spike_and_show_their_gap() -> None:
    duty = np.zeros(10_000)
    duty[3_000:6_000] = np.nan
    duty[2_999] = duty[6_000] = 3.0
    kept = rows_to_keep({"duty": duty}, 100)
    assert {2_999, 6_000} <= set(kept)
    assert set(kept[np.isnan(duty[kept])]) == {3_000, 5_999}


@pytest.mark.parametrize("unknown", [slice(None), slice(0, None, 2), slice(1, None)])
def test_mostly_unknown_channels_are_reduced_too(unknown: slice) -> None:
    duty = np.arange(10_000.0)
    duty[unknown] = np.nan
    kept = rows_to_keep({"duty": duty}, 100)
    assert 2 <= len(kept) <= 204


def test_the_store_reduces_with_the_time_beside(store: Store) -> None:
    time_s = np.linspace(0, 10, 20_000)
    duty = np.where(np.arange(20_000) == 12_345, 0.9, 0.1)
    writer = begin_trial(store, begin(store))
    writer.append(np.column_stack([time_s, np.full(20_000, np.nan), duty]))
    found = store.samples_reduced(writer.trial_id, ["duty"], 200)
    assert list(found) == ["time_s", "duty"]
    assert found["time_s"].shape == found["duty"].shape
    assert len(found["duty"]) <= 202
    assert found["time_s"][np.argmax(found["duty"])] == time_s[12_345]


def test_too_few_points_are_refused(store: Store) -> None:
    with pytest.raises(StoreValueError, match="points is 3; wanted at least 4"):
        store.samples_reduced(1, None, 3)
