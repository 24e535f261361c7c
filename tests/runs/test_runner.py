"""The runner, on the simulated bench and a store in a file: what it does is on record, however it ends."""

import threading
import time
from contextlib import contextmanager

import numpy as np
import pytest

from bench.config.channels import RECORDED
from bench.config.configuration import default_configuration
from bench.control import station
from bench.control.drive_factory import Equipment
from bench.errors import BusyError, ConfigurationError, LimitError, ParameterError, UnknownKindError
from bench.runs.runner import HostProcess, Runner
from bench.store import Store
from bench.store.errors import StoreFullError
from bench.store.sqlite import Sqlite
from bench.store.trial_store import TrialWriter
from drivers.errors import DriveConnectionError
from tests.control.fake_drive import FakeDrive


@pytest.fixture
def store(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


@pytest.fixture
def runner(store):
    made = Runner(default_configuration(), store)
    yield made
    made.close()


def finished(runner, timeout_s=60.0):
    assert runner.wait(timeout_s), f"still running: {runner.status()}"
    return runner.status()


def test_the_next_experiment_starts_as_soon_as_the_one_before_is_over(store):
    @contextmanager
    def slowly_left(_real_time):
        yield
        time.sleep(0.5)

    runner = Runner(default_configuration(), store, HostProcess(during_run=slowly_left))
    first = runner.start("steps", {"repeats": 1})
    while runner.status().outcome == "running":
        time.sleep(0.01)
    assert not runner.wait(0.0)  # its thread is still there
    assert runner.start("steps", {"repeats": 1}) == first + 1
    runner.close()


def test_an_experiment_from_start_to_record(runner, store):
    assert runner.status().outcome == ""
    experiment_id = runner.start("steps", {"repeats": 2}, operator="R. Saini", note="first")
    status = finished(runner)
    assert (status.outcome, status.reason, status.progress, status.trial_count) == ("completed", "", 1.0, 2)
    assert status.left_s == 0.0 < status.duration_s
    experiment = store.experiment(experiment_id)
    assert (experiment.outcome, experiment.source, experiment.operator) == ("completed", "simulated", "R. Saini")
    assert experiment.parameters["load_kg"] == 0.1  # defaults are on record too
    assert experiment.provenance["seed"] == 1
    assert experiment.provenance["drive"]["simulated"]
    assert experiment.results["estimates"] == 2
    trials = store.trials(experiment_id)
    assert [trial.name for trial in trials] == ["step-001", "step-002"]
    assert trials[0].results["overruns"] == 0
    samples = store.samples(trials[0].id)
    assert set(samples) == set(RECORDED)
    assert len(samples["time_s"]) == trials[0].rows == trials[0].results["cycles"]
    assert [event.name for event in store.events(trials[0].id)][-1] == "end"


def test_the_same_seed_gives_the_same_samples(runner, store):
    ids = []
    for _ in range(2):
        ids.append(runner.start("steps", {"repeats": 1}))
        finished(runner)
    first, second = (store.samples(store.trials(each)[0].id) for each in ids)
    for name in RECORDED:
        np.testing.assert_array_equal(first[name], second[name])


@pytest.mark.parametrize(
    ("parameters", "error", "message"),
    [
        ({"load_kg": 5.0}, LimitError, "load_kg is 5 kg; allowed is at most 0.1 kg"),
        ({"load": 5.0}, ParameterError, "load: unknown key"),
    ],
)
def test_a_refused_start_is_on_record_and_moves_nothing(runner, store, parameters, error, message):
    with pytest.raises(error, match=message):
        runner.start("steps", parameters, operator="me")
    [experiment] = store.experiments()
    assert (experiment.outcome, experiment.operator) == ("refused", "me")
    assert message in experiment.reason
    assert store.trials() == []
    assert runner.status().outcome == "refused"


def test_an_unknown_kind_is_no_experiment(runner, store):
    with pytest.raises(UnknownKindError):
        runner.start("jump", {})
    assert store.experiments() == []


def test_an_impossible_plant_is_refused(store):
    configuration = default_configuration()
    drive = configuration.drive.model_copy(update={"preset": "none"})
    runner = Runner(configuration.model_copy(update={"drive": drive}), store)
    with pytest.raises(ConfigurationError):
        runner.start("steps", {})
    assert store.experiments()[0].outcome == "refused"


def test_an_unknown_pace_is_refused(runner):
    with pytest.raises(ParameterError, match="allowed is real-time or fast"):
        runner.start("steps", {}, pace="leisurely")


def wait_for(condition, timeout_s=20.0):
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline_s, "waited in vain"
        time.sleep(0.005)


def test_stop_powers_off_and_says_why(runner, store):
    experiment_id = runner.start("steps", {"repeats": 3}, pace="real-time")
    wait_for(lambda: len(runner.live().rows) > 20)
    asked_s = time.monotonic()
    runner.stop("cable is caught")
    status = finished(runner)
    assert time.monotonic() - asked_s < 2.0
    assert status.outcome == "stopped"
    assert status.reason == "trial 'step-001': cable is caught"
    [trial] = store.trials(experiment_id)
    assert (trial.outcome, trial.reason) == ("stopped", "cable is caught")
    assert store.samples(trial.id, ["enabled"])["enabled"][-1] == 0.0
    assert (store.events(trial.id)[-1].name, store.events(trial.id)[-1].detail) == ("end", "stopped; cable is caught")
    assert store.experiment(experiment_id).outcome == "stopped"


def test_a_disk_without_room_refuses_before_anything_moves(runner, store, monkeypatch):
    monkeypatch.setattr(Sqlite, "free_bytes", lambda _self: 150_000_000)
    with pytest.raises(StoreFullError, match=r"150 MB are free on its disk; 3 trials .*reserve of 200 MB need"):
        runner.start("steps", {"repeats": 3})
    [experiment] = store.experiments()
    assert experiment.outcome == "refused"
    assert "150 MB are free" in experiment.reason


def test_only_one_at_a_time(runner, store):
    first = runner.start("steps", {}, pace="real-time")
    with pytest.raises(BusyError, match=f"experiment {first}"):
        runner.start("steps", {})
    assert len(store.experiments()) == 1
    runner.stop()
    finished(runner)


def test_live_rows_are_those_of_the_running_trial(runner):
    runner.start("steps", {"repeats": 1}, pace="real-time")
    wait_for(lambda: runner.live().last_row > 10)
    first = runner.live()
    assert first.channels == RECORDED
    wait_for(lambda: runner.live().last_row > first.last_row)
    then = runner.live(first.last_row)
    assert not then.restarted
    assert then.rows[0, 0] > first.rows[-1, 0]
    status = runner.status()
    assert status.outcome == "running"
    assert 0.0 < status.progress < 1.0
    assert status.reading is not None
    runner.stop()


def test_close_stops_and_nothing_starts_afterwards(store):
    runner = Runner(default_configuration(), store)
    experiment_id = runner.start("steps", {}, pace="real-time")
    runner.close()
    assert store.experiment(experiment_id).outcome == "stopped"
    with pytest.raises(BusyError, match="closed"):
        runner.start("steps", {})


@pytest.fixture
def fake(monkeypatch):
    """A fake drive in place of the simulated one."""
    drive = FakeDrive()
    monkeypatch.setattr(station, "make_equipment", lambda _configuration, _ask: Equipment(drive, drive))
    yield drive
    assert not drive.powered


def test_a_drive_that_does_not_answer_is_a_failed_start(runner, store, fake):
    def refuse(_period_s):
        raise DriveConnectionError("fake", "no answer in 0.3 s; check the cable")

    fake.open = refuse
    with pytest.raises(DriveConnectionError):
        runner.start("steps", {})
    [experiment] = store.experiments()
    assert (experiment.outcome, experiment.reason) == ("failed", "drive 'fake': no answer in 0.3 s; check the cable")


def test_a_trip_ends_the_experiment_and_closes_the_drive(runner, store, fake):
    fake.alter = lambda cycle, sample: sample._replace(temperature_c=99.0) if cycle == 30 else sample
    experiment_id = runner.start("steps", {"repeats": 3})
    status = finished(runner)
    assert status.outcome == "tripped"
    assert "temperature is 99 degC; allowed is at most 80 degC" in status.reason
    assert fake.calls[-1] == "close"
    assert [trial.outcome for trial in store.trials(experiment_id)] == ["tripped"]


def test_a_technician_who_gives_up_ends_the_experiment(runner, store, fake):
    def refuse(_load_kg, _balanced):
        raise ParameterError("the hook is broken")

    fake.hang_load = refuse
    runner.start("steps", {})
    status = finished(runner)
    assert (status.outcome, status.reason) == ("failed", "trial 'step-001': the hook is broken")
    assert fake.calls[-1] == "close"


def test_a_store_that_fails_in_mid_trial_ends_in_power_off(runner, store, monkeypatch):
    def full(_self, _rows, _events):
        raise OSError("No space left on device")

    monkeypatch.setattr(TrialWriter, "append", full)
    runner.start("steps", {"repeats": 2})
    status = finished(runner)
    assert status.outcome == "failed"
    assert "No space left on device" in status.reason
    assert status.trial_index == 0


def test_a_store_that_does_not_take_the_experiment_leaves_the_drive_off(runner, store, fake, monkeypatch):
    def locked(*_arguments):
        raise OSError("database is locked")

    monkeypatch.setattr(store, "begin_experiment", locked)
    with pytest.raises(OSError, match="locked"):
        runner.start("steps", {})
    assert fake.calls[-1] == "close"
    assert runner.status().outcome == "failed"


def test_stop_reaches_an_experiment_that_is_only_starting(runner, fake):
    opened = threading.Event()

    def open_and_stop(period_s):
        FakeDrive.open(fake, period_s)
        runner.stop("changed my mind")
        opened.set()

    fake.open = open_and_stop
    runner.start("steps", {})
    status = finished(runner)
    assert opened.is_set()
    assert (status.outcome, status.reason) == ("stopped", "changed my mind")
    assert fake.commands == []
