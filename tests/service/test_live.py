"""The live stream goes on where it was left."""

import json
from dataclasses import replace
from math import nan

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.control.cycle import Reading
from bench.runs.bench_control import RunnerStatus
from bench.runs.live import LiveBuffer
from bench.service.live.replay import MOST_REPLAYED, GapError, Mark, missed
from bench.service.live.status import status_of
from bench.store import Store
from drivers.contract import Sample, Status
from tests.service.listening import hear, left_at, listen, of_run, recorded, rows_of, times, until

LIFE = "0123abcd"


def test_what_was_missed_comes_out_of_memory(idle):
    running = idle.start("steps", pace="real-time", repeats=1)
    first = hear(idle, running, 100)
    hear(idle, running, len(of_run(idle, running, first)) + 200)  # time passes
    rest = hear(idle, running, 300, left_at(first))
    idle.client.post("/stop")
    assert idle.runner.wait(10.0)
    heard = of_run(idle, running, first) + rows_of(rest)
    assert heard == recorded(idle, running)[: len(heard)]
    assert "gap" not in {name for name, _, _ in rest}


def test_what_memory_has_lost_comes_out_of_the_store(idle):
    experiment_id = idle.start("steps", pace="fast", repeats=3)
    assert idle.runner.wait(60.0)
    trials = idle.store.trials(experiment_id)
    mark = Mark("00000000", 5, trials[0].id, 1000)  # of a service before this one
    wanted = [idle.store.samples(trial.id)["time_s"].tolist() for trial in trials]
    wanted[0] = wanted[0][1000:]
    whole = [time_s for part in wanted for time_s in part]
    found = until(listen(idle.url, str(mark)), lambda found: len(times(found)) >= len(whole))
    assert times(found) == whole
    names = [data["trial_id"] for name, _, data in found if name == "rows" and data["restarted"]]
    assert names == [trial.id for trial in trials[1:]]
    middle = [number for name, number, _ in found if name == "rows"][1]
    rest = until(listen(idle.url, middle), lambda found: "status" in {name for name, _, _ in found})
    assert times(rest) == whole[4000:]


@pytest.mark.parametrize(("mark", "words"), [("17", "none of this service"), (f"{LIFE}.5.999999.3", "are gone")])
def test_a_gap_is_said(idle, mark, words):
    [gap, *_] = until(listen(idle.url, mark), lambda found: len(found) == 2)
    assert gap[0] == "gap"
    assert words in gap[2]["detail"]


@pytest.fixture
def store(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


def record(store: Store, experiment_id: int, name: str, rows: int) -> int:
    writer = store.begin_trial(experiment_id, name, "steps", {}, ("time_s",))
    writer.append(np.arange(rows, dtype=float)[:, None])
    writer.finish("completed")
    return writer.trial_id


def experiment(store: Store) -> int:
    return store.begin_experiment("steps", {}, "simulated", {}, {})


def live_at(trial_id: int | None, rows: int):
    buffer = LiveBuffer(("time_s",))
    buffer.begin_trial(trial_id=trial_id)
    buffer.append(np.zeros((rows, 1)))
    return buffer.since(-1, 1)


def pieces(store, mark, now):
    return [(piece.trial.id, piece.first_row, piece.rows) for piece in missed(store, mark, now)]


def test_missed_rows_end_where_the_live_ones_begin(store):
    one = experiment(store)
    a, b, c = (record(store, one, name, 3000) for name in "abc")
    assert pieces(store, Mark(LIFE, 0, a, 2500), live_at(c, 100)) == [
        (a, 2500, 500),
        (b, 0, 2000),
        (b, 2000, 1000),
        (c, 0, 100),
    ]
    assert pieces(store, Mark(LIFE, 0, c, 100), live_at(c, 150)) == [(c, 100, 50)]
    assert pieces(store, Mark(LIFE, 0, c, 2999), live_at(None, 0)) == [(c, 2999, 1)]
    store.finish_experiment(one, "completed")
    two = experiment(store)
    d, e = (record(store, two, name, 10) for name in "de")
    assert pieces(store, Mark(LIFE, 0, c, 2990), live_at(e, 4)) == [(c, 2990, 10), (d, 0, 10), (e, 0, 4)]


def test_more_than_is_sent_again_is_a_gap(store):
    trial_id = record(store, experiment(store), "a", MOST_REPLAYED + 2)
    with pytest.raises(GapError, match=f"GET /trials/{trial_id}/csv"):
        missed(store, Mark(LIFE, 0, trial_id, 1), live_at(trial_id, MOST_REPLAYED + 2))
    with pytest.raises(GapError, match="not known"):
        missed(store, Mark(LIFE, 0, 0, 0), live_at(trial_id, 1))


def test_marks_read_back():
    mark = Mark(LIFE, -1, 12, 3400)
    assert Mark.read(str(mark)) == mark
    for other in ("", "5", "x.1.2.3", f"{LIFE}.1.2", f"{LIFE}.1.2.3.4", f"{LIFE}.1.2.{'9' * 30}"):
        assert Mark.read(other) is None


@pytest.mark.parametrize("measured", [False, True])
def test_a_current_that_is_not_measured_is_told_as_an_estimate(measured):
    sample = Sample(0.0, 0.0, 0.5, 0.6, 0.7, 0.8 if measured else nan, 24.0, nan, Status.ENABLED)
    reading = Reading(2.0, sample, 0.6, 0.8, 0.82)
    runner = RunnerStatus(1, "steps", "running", "", 0, 1, 0.0, reading, None, default_configuration().limits)
    told = json.loads(status_of(runner, True, None).model_dump_json())["reading"]
    assert (told["current_a"], told["current_measured"], told["current_estimate_a"]) == (0.8, measured, 0.82)
    nothing = Reading(2.0, sample._replace(current_a=nan), 0.6, nan, nan)
    told = json.loads(status_of(replace(runner, reading=nothing), True, None).model_dump_json())["reading"]
    assert (told["current_a"], told["current_measured"], told["current_estimate_a"]) == (None, False, None)
