"""The overview: the rows that a plot of a long trial needs."""

import numpy as np
import pytest
from sqlalchemy import delete

from bench.store import Store
from bench.store.schema import SAMPLE_OVERVIEW
from bench.store.tables.plotted.overview import GROUP_ROWS, overview_of
from bench.store.tables.samples import columns_of
from tests.store.examples import CHANNELS, begin, begin_trial


def long_rows(count: int, seed: int = 3) -> np.ndarray:
    """Rows of noise with spikes of one sample, and a channel that is known in the middle alone."""
    generator = np.random.default_rng(seed)
    time_s = np.arange(count) * 1e-3
    position = generator.normal(size=count)
    position[[count // 3, count // 2]] = [40.0, -50.0]
    duty = np.full(count, np.nan)
    duty[count // 4 : count // 2] = generator.normal(size=count // 2 - count // 4)
    return np.column_stack([time_s, position, duty])


def test_each_group_keeps_the_extremes_of_each_channel() -> None:
    columns = columns_of(long_rows(5 * GROUP_ROWS + 17))
    found = overview_of(columns)
    assert found.covered == 5 * GROUP_ROWS
    assert np.all(np.diff(found.rows) > 0)
    assert np.array_equal(found.columns, columns[:, found.rows], equal_nan=True)
    for group in range(5):
        inside = slice(group * GROUP_ROWS, (group + 1) * GROUP_ROWS)
        for channel in (1, 2):
            values = columns[channel, inside]
            if np.isnan(values).all():
                continue
            asked = found.rows[(found.asked_by >> channel) & 1 == 1]
            assert {int(np.nanargmin(values)), int(np.nanargmax(values))} <= set(asked - inside.start)


def test_both_sides_of_where_a_channel_is_known_are_kept() -> None:
    columns = columns_of(long_rows(8 * GROUP_ROWS))
    kept = set(overview_of(columns).rows)
    first, last = np.flatnonzero(~np.isnan(columns[2]))[[0, -1]]
    assert {first - 1, first, last, last + 1} <= kept


def test_a_channel_that_comes_and_goes_keeps_no_edges() -> None:
    columns = columns_of(long_rows(4 * GROUP_ROWS))
    columns[2, ::2] = np.nan
    columns[2, 1::2] = 1.0
    assert len(overview_of(columns).rows) < 40


@pytest.mark.parametrize("append", [20, 100, GROUP_ROWS, 5000, 100_000])
def test_a_plot_shows_every_spike_however_the_rows_came(store: Store, append: int) -> None:
    count = 100_000 if append > 100 else 20_000
    rows = long_rows(count)
    writer = begin_trial(store, begin(store))
    for start in range(0, count, append):
        writer.append(rows[start : start + append])
    found = store.samples_reduced(writer.trial_id, None, 12)
    assert list(found) == list(CHANNELS)
    assert len(found["time_s"]) < 60
    assert found["position_rad"].max() == 40.0
    assert found["position_rad"].min() == -50.0
    assert np.nanmax(found["duty"]) == np.nanmax(rows[:, 2])
    assert (found["time_s"][0], found["time_s"][-1]) == (rows[0, 0], rows[-1, 0])
    for row in np.column_stack(list(found.values())):  # as they were recorded
        assert np.array_equal(row, rows[round(row[0] * 1e3)], equal_nan=True)
    assert np.isnan(found["duty"]).any()  # the gap is seen


def test_the_overview_is_what_is_read(store: Store) -> None:
    """Else the test above would pass without one."""
    rows = long_rows(100_000)
    writer = begin_trial(store, begin(store))
    writer.append(rows)
    trial = store.trial(writer.trial_id)
    from bench.store.tables import samples

    with store._database.reading() as connection:
        found, asked = samples.read_overview(connection, trial, ["time_s", "position_rad"])
    covered = 100_000 // GROUP_ROWS * GROUP_ROWS
    assert len(found["time_s"]) <= 4 * 100_000 // GROUP_ROWS + 100_000 - covered + 10
    assert asked["position_rad"].sum() < len(found["time_s"])


def test_a_trial_without_an_overview_is_plotted_too(store: Store) -> None:
    rows = long_rows(60_000)
    writer = begin_trial(store, begin(store))
    writer.append(rows)
    with store._database.writing() as connection:
        connection.execute(delete(SAMPLE_OVERVIEW))
    found = store.samples_reduced(writer.trial_id, None, 12)
    assert found["position_rad"].max() == 40.0


def test_an_append_that_failed_leaves_the_overview_as_it_was(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = long_rows(4 * GROUP_ROWS)
    writer = begin_trial(store, begin(store))
    writer.append(rows[:700])
    with monkeypatch.context() as broken:
        broken.setattr("bench.store.tables.samples._COUNT", None)
        with pytest.raises(Exception, match="executable"):
            writer.append(rows[700:])
    writer.append(rows[700:])
    found = store.samples_reduced(writer.trial_id, None, 4)
    assert found["position_rad"].min() == -50.0
    assert np.array_equal(store.samples(writer.trial_id)["time_s"], rows[:, 0])
