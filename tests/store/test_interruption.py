"""What remains when the process that measures is gone, and what a living one is spared."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from bench.store import Store
from tests.store.examples import begin, begin_trial, rows

# writes blocks of 25 rows for ever and says after each which rows are committed
WRITER = """
import sys
from bench.store import Store
from tests.store.examples import begin, begin_trial, rows
store = Store.open(sys.argv[1])
writer = begin_trial(store, begin(store), load_kg=0.1)
while True:
    writer.append(rows(writer.rows, 25))
    print(writer.rows, flush=True)
"""


def start_writer(url: str) -> "subprocess.Popen[str]":
    root = Path(__file__).parents[2]
    return subprocess.Popen([sys.executable, "-c", WRITER, url], stdout=subprocess.PIPE, text=True, cwd=root)


def kill(process: "subprocess.Popen[str]") -> int:
    """Kill with SIGKILL; returns the rows that it had said to be committed."""
    process.send_signal(signal.SIGKILL)
    output, _ = process.communicate()
    whole = output[: output.rfind("\n")].splitlines()
    return int(whole[-1]) if whole else 0


def opened_after_a_death(url: str) -> Store:
    """The store, once it has been seen that the process is gone: a server needs a moment to see it."""
    deadline_s = time.monotonic() + 10.0
    while True:
        store = Store.open(url)
        if not store.experiments(outcome="running") or time.monotonic() > deadline_s:
            return store
        store.close()
        time.sleep(0.05)


def test_what_was_committed_survives_a_kill_at_any_moment(url: str) -> None:
    generator = np.random.default_rng(7)
    for delay_s in generator.uniform(0.0, 0.15, size=4):
        process = start_writer(url)
        assert process.stdout is not None
        first = int(process.stdout.readline())
        time.sleep(delay_s)
        committed = max(first, kill(process))
        with opened_after_a_death(url) as store:
            experiment = store.experiments(limit=1)[0]
            (trial,) = store.trials(experiment.id)
            assert (experiment.outcome, trial.outcome) == ("interrupted", "interrupted")
            assert "killed" in experiment.reason
            assert "killed" in trial.reason
            assert committed <= trial.rows <= committed + 25
            assert np.array_equal(store.samples(trial.id)["time_s"], np.arange(float(trial.rows)))


def test_a_bench_that_runs_in_another_process_is_left_running(url: str) -> None:
    process = start_writer(url)
    try:
        assert process.stdout is not None
        process.stdout.readline()
        with Store.open(url) as store:
            assert [experiment.outcome for experiment in store.experiments()] == ["running"]
        assert int(process.stdout.readline()) >= 25  # it goes on writing
    finally:
        kill(process)
    with opened_after_a_death(url) as store:
        assert [experiment.outcome for experiment in store.experiments()] == ["interrupted"]


def test_a_bench_that_runs_in_this_process_is_left_running(store: Store, store_url: str) -> None:
    experiment_id = begin(store)
    for _ in range(2):  # looking must not let go of the lock
        with Store.open(store_url) as other:
            assert other.experiment(experiment_id).outcome == "running"
    begin_trial(store, experiment_id).append(rows(0, 5))


def test_closing_marks_what_it_left_running(url: str) -> None:
    with Store.open(url) as store:
        experiment_id = begin(store)
        trial_id = begin_trial(store, experiment_id).trial_id
    with Store.open(url) as store:
        assert (
            store.experiment(experiment_id).reason
            == store.trial(trial_id).reason
            == "the store was closed while it ran"
        )
        assert store.trial(trial_id).outcome == "interrupted"


def test_closing_spares_what_others_run(store: Store, store_url: str) -> None:
    mine = begin(store)
    with Store.open(store_url) as other:
        theirs = begin(other)
    assert store.experiment(mine).outcome == "running"
    assert store.experiment(theirs).outcome == "interrupted"


@pytest.mark.parametrize("outcome", ["completed", "stopped"])
def test_what_ended_stays_as_it_ended(url: str, outcome: str) -> None:
    with Store.open(url) as store:
        experiment_id = begin(store)
        store.finish_experiment(experiment_id, outcome)
    with Store.open(url) as store:
        assert store.experiment(experiment_id).outcome == outcome
