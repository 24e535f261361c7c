"""A stretch of a trial for a plot: the rows that lie in it, at all sizes."""

import numpy as np
import pytest

from bench.store import Store
from tests.store.examples import begin, begin_trial

ROWS = 20_000


@pytest.fixture(scope="module")
def trial(tmp_path_factory):
    """Twenty thousand rows at irregular times, one spike among them."""
    with Store.open(f"sqlite:///{tmp_path_factory.mktemp('window') / 'bench.sqlite'}") as store:
        time_s = np.sort(np.random.default_rng(5).uniform(0.0, 100.0, ROWS))
        duty = np.where(np.arange(ROWS) == 12_345, 0.9, 0.1)
        writer = begin_trial(store, begin(store))
        writer.append(np.column_stack([time_s, np.zeros(ROWS), duty]))
        yield store, writer.trial_id, time_s


@pytest.mark.parametrize(("from_s", "to_s"), [(10.0, 10.5), (0.0, 0.2), (99.9, 100.0), (40.9, 41.1)])
def test_a_short_stretch_has_all_its_rows_and_one_more_on_both_sides(trial, from_s, to_s):
    store, number, time_s = trial
    found = store.samples_reduced(number, ["duty"], 4000, (from_s, to_s))["time_s"]
    inside = np.flatnonzero((time_s >= from_s) & (time_s <= to_s))
    wanted = time_s[max(0, inside[0] - 1) : min(ROWS, inside[-1] + 2)]
    np.testing.assert_array_equal(found, wanted)


@pytest.mark.parametrize("points", [4, 20, 400])
def test_a_long_stretch_keeps_its_extremes(trial, points):
    store, number, time_s = trial
    found = store.samples_reduced(number, ["duty"], points, (time_s[12_345] - 20.0, time_s[12_345] + 20.0))
    assert found["duty"].max() == 0.9
    assert len(found["time_s"]) <= points + 6
    assert np.ptp(found["time_s"]) <= 41.0


def test_a_stretch_without_rows_is_empty_and_one_without_ends_is_all(trial):
    store, number, _ = trial
    assert len(store.samples_reduced(number, ["duty"], 100, (500.0, 600.0))["time_s"]) <= 1
    assert len(store.samples_reduced(number, ["duty"], 100, (50.0, 20.0))["time_s"]) == 0
    whole = store.samples_reduced(number, ["duty"], 100)
    same = store.samples_reduced(number, ["duty"], 100, (-np.inf, np.inf))
    np.testing.assert_array_equal(whole["time_s"], same["time_s"])
