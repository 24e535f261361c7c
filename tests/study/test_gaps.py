"""Where nothing of a trial is used, its plots have a gap, not a line."""

from dataclasses import replace

import numpy as np
import pytest

from bench.recording_set import import_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.report.section import Figure, Line
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.plots.series import drivers_over_time
from bench.study.report.model_sections import measured_figure
from tests.lab.synthetic import plans, recordings
from tests.study.conftest import HIDDEN, QUICK, RIG

GAP_S = (3.0, 5.0)


@pytest.fixture(scope="module")
def number(store) -> int:
    made = [_interrupted(one) for one in recordings(HIDDEN, QUICK, plans(loads_kg=(0.0, 0.2), repeats=1), seed=3)]
    experiment_id = import_recording_set(store, RecordingSet("set", RIG, made), "interrupted")
    return create_study(store, "interrupted", [experiment_id], rows="all").study_id


def _interrupted(recording):
    time_s = recording.channels["time_s"]
    kept = (time_s < GAP_S[0]) | (time_s > GAP_S[1])
    return replace(recording, channels={name: values[kept] for name, values in recording.channels.items()})


def test_a_gap_stands_in_every_line_over_time(store, number):
    found = compare(store, number)
    for series in found.series:
        time_s, unknown = np.array(series.time_s), np.isnan(series.measured)
        assert unknown.sum() == 1
        assert GAP_S[0] < time_s[unknown][0] < GAP_S[1]
        assert (np.diff(time_s) > 0.0).all()
        assert np.isnan(series.residual).tolist() == np.isnan(series.predicted).tolist() == unknown.tolist()
        drivers = drivers_over_time(store, number, series.trial_id)
        assert drivers.time_s == series.time_s
        assert all(np.isnan(one.values).tolist()[unknown.argmax()] for one in drivers.drivers)


def test_lines_of_a_report_are_interrupted_and_it_can_be_written(store, number):
    found = compare(store, number)
    for trace in measured_figure(found, found).to_plotly()["data"]:
        assert trace["y"].count(None) == 1


def test_a_point_between_two_gaps_has_a_mark():
    nan = float("nan")
    drawn = Figure("", "", "", [Line("a", range(6), [1.0, nan, 2.0, 3.0, nan, 4.0])]).to_plotly()["data"][0]
    assert drawn["marker"]["size"] == [6, 0, 0, 0, 0, 6]
    whole = Figure("", "", "", [Line("a", range(2), [1.0, 2.0])]).to_plotly()["data"][0]
    assert whole["mode"] == "lines"


def test_the_gaps_of_a_trial_are_told_from_its_times(store, number):
    trial_id = compare(store, number).trials[0].trial_id
    ((from_s, to_s),) = store.time_gaps(trial_id)
    assert from_s < GAP_S[0] + 0.01
    assert to_s > GAP_S[1] - 0.01


def test_trials_without_a_row_that_counts_are_told(store):
    *made, last = recordings(HIDDEN, QUICK, plans(loads_kg=(0.0, 0.2), repeats=1), seed=3)
    still = {"position_rad": np.zeros_like(last.channels["position_rad"])}
    made.append(replace(last, channels={**last.channels, **still}))
    experiment_id = import_recording_set(store, RecordingSet("set", RIG, made), "still")
    found = compare(store, create_study(store, "still", [experiment_id]).study_id)
    assert [np.isnan(one.rms) for one in found.trials] == [False] * (len(made) - 1) + [True]
    assert found.notes[1] == f"1 of {len(made)} trials have no such row, and no error of their own."
