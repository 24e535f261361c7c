"""The control loop in a process of its own: the same answers as in this one, and a clean end whoever dies."""

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from bench.config.channels import RECORDED
from bench.config.configuration import BenchConfiguration, default_configuration
from bench.errors import BusyError, LimitError, OutOfRange, ParameterError, PromptError, UnknownKindError
from bench.runs.bench_process import process
from bench.runs.bench_process.child import Child
from bench.runs.bench_process.errors import BenchProcessError, NotBegunError
from bench.runs.bench_process.messages import error_of, failure_of
from bench.runs.bench_process.remote_runner import RemoteRunner
from bench.runs.bench_process.stop_line import LineStop, StopLine
from bench.runs.bench_process.supervisor import Supervisor
from bench.runs.runner import Runner
from bench.store import Store
from bench.store.errors import StoreFileError
from drivers.errors import DriveConnectionError

pytestmark = [
    pytest.mark.skipif(os.name != "posix", reason="signals of POSIX"),
    pytest.mark.timeout(240),  # a process takes its time to start where others want the machine, too
]
PATIENCE_S = 60.0


def configured(database: Path) -> BenchConfiguration:
    found = default_configuration()
    store = found.store.model_copy(update={"url": f"sqlite:///{database}"})
    return found.model_copy(update={"store": store})


def wait_for(condition: Callable[[], object]) -> None:
    deadline_s = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < deadline_s, "waited in vain"
        time.sleep(0.01)


def is_there(process_id: int) -> bool:
    """Whether a process runs; one that has ended and nobody has asked after does not."""
    try:
        return Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Store]:
    database = tmp_path_factory.mktemp("bench process") / "bench.sqlite"
    with Store.open(f"sqlite:///{database}") as opened:
        yield opened


@pytest.fixture(scope="module")
def remote(store: Store) -> Iterator[RemoteRunner]:
    with closing(RemoteRunner(configured(Path(store.upkeep.info().where)), store)) as made:
        yield made


@pytest.fixture
def runner(remote: RemoteRunner) -> Iterator[RemoteRunner]:
    """With nothing running, before and after."""
    yield remote
    remote.stop("the next test begins")
    assert remote.wait(PATIENCE_S)


def set_going(runner: RemoteRunner) -> int:
    """Start something that takes a while, and return its id when its first rows have been recorded."""
    before = runner.live().last_row
    experiment_id = runner.start("steps", {"repeats": 3}, pace="real-time")
    wait_for(lambda: len(runner.live(before).rows) > 20)
    return experiment_id


def process_of(runner: RemoteRunner) -> int:
    return runner._supervisor.child().process_id


def test_the_same_samples_as_in_this_process(runner, store):
    far = runner.start("steps", {"repeats": 1}, operator="R. Saini", pace="fast")
    assert runner.wait(PATIENCE_S)
    status = runner.status()
    assert (status.outcome, status.progress, status.experiment_id) == ("completed", 1.0, far)
    record = store.experiment(far)
    assert (record.outcome, record.operator) == ("completed", "R. Saini")
    assert "SCHED_FIFO" in record.provenance["control_loop"]["scheduling"]
    with closing(Runner(runner.configuration, store)) as near:
        here = near.start("steps", {"repeats": 1}, pace="fast")
        assert near.wait(PATIENCE_S)
    first, second = (store.samples(store.trials(each)[0].id) for each in (far, here))
    for name in RECORDED:
        np.testing.assert_array_equal(first[name], second[name])


@pytest.mark.parametrize(
    ("kind", "parameters", "error", "message"),
    [
        ("steps", {"load_kg": 5.0}, LimitError, "load_kg is 5 kg; allowed is at most 0.1 kg"),
        ("steps", {"load": 5.0}, ParameterError, "load: unknown key"),
        ("jump", {}, UnknownKindError, "jump"),
    ],
)
def test_a_refusal_comes_across_with_its_class_and_text(runner, store, kind, parameters, error, message):
    with pytest.raises(error, match=message) as caught:
        runner.start(kind, parameters)
    with closing(Runner(runner.configuration, store)) as near, pytest.raises(error) as there:
        near.start(kind, parameters)
    assert str(caught.value) == str(there.value)
    assert type(caught.value) is type(there.value)


def test_an_answer_to_what_is_not_asked(runner):
    with pytest.raises(PromptError, match="prompt 3 is not open"):
        runner.answer(3)


def test_one_at_a_time_and_stop_says_why(runner, store):
    experiment_id = set_going(runner)
    with pytest.raises(BusyError, match=f"experiment {experiment_id}"):
        runner.start("steps", {})
    runner.stop("cable is caught")
    runner.stop("and now I say something else")
    assert runner.wait(PATIENCE_S)
    assert (runner.status().outcome, runner.status().reason) == ("stopped", "trial 'step-001': cable is caught")
    assert store.experiment(experiment_id).outcome == "stopped"


def test_stop_passes_a_way_that_is_blocked(runner):
    set_going(runner)
    with runner._supervisor.child()._sending:  # no message gets through
        runner.stop("through the wall")
        assert runner.wait(PATIENCE_S)
    assert runner.status().outcome == "stopped"


def test_a_pause_is_honoured_and_said(runner):
    set_going(runner)
    runner.pause()
    wait_for(lambda: runner.status().pausing == "asked")
    runner.resume()
    wait_for(lambda: runner.status().pausing == "")
    assert runner.status().outcome == "running"


def test_a_stop_from_before_does_not_count(runner):
    runner.stop("too early")
    runner.start("steps", {"repeats": 1}, pace="fast")
    assert runner.wait(PATIENCE_S)
    assert runner.status().outcome == "completed"


def test_live_rows_are_the_recorded_ones_and_start_over(runner, store):
    runner.start("steps", {"repeats": 1}, pace="fast")
    assert runner.wait(PATIENCE_S)
    before = runner.live().last_row
    experiment_id = runner.start("steps", {"repeats": 1}, pace="real-time")
    wait_for(lambda: len(runner.live(before).rows) > 100)
    rows = runner.live(before)
    runner.stop()
    assert runner.wait(PATIENCE_S)
    assert rows.restarted
    recorded = store.samples(store.trials(experiment_id)[0].id)
    np.testing.assert_array_equal(rows.rows[:, 0], recorded["time_s"][: len(rows.rows)])


def test_kill_of_the_bench_process_is_said_and_the_next_start_works(runner, store):
    experiment_id = set_going(runner)
    killed = process_of(runner)
    os.kill(killed, signal.SIGKILL)
    assert runner.wait(PATIENCE_S)
    status = runner.status()
    assert status.outcome == "interrupted"
    assert "ended by SIGKILL" in status.reason
    assert "watchdog stops the motor within 0.1 s" in status.reason
    wait_for(lambda: store.experiment(experiment_id).outcome != "running")
    assert (store.experiment(experiment_id).outcome, store.experiment(experiment_id).reason) == (
        "interrupted", status.reason,
    )  # fmt: skip
    last_row = runner.live().last_row
    runner.start("steps", {"repeats": 1}, pace="fast")
    assert runner.wait(PATIENCE_S)
    assert runner.status().outcome == "completed"
    assert process_of(runner) != killed
    assert runner.live(last_row).restarted


def test_a_start_finds_the_next_process_though_the_end_of_the_last_one_is_seen_late(tmp_path, monkeypatch):
    listen = Supervisor._listen

    def late(supervisor: Supervisor, child: Child) -> BaseException | None:
        found = listen(supervisor, child)
        time.sleep(0.3)  # a busy machine
        return found

    monkeypatch.setattr(Supervisor, "_listen", late)
    database = tmp_path / "bench.sqlite"
    with Store.open(f"sqlite:///{database}") as own, closing(RemoteRunner(configured(database), own)) as runner:
        runner.start("steps", {"repeats": 1}, pace="fast")
        assert runner.wait(PATIENCE_S)
        killed = process_of(runner)
        os.kill(killed, signal.SIGKILL)
        os.waitid(os.P_PID, killed, os.WEXITED | os.WNOWAIT)
        runner.start("steps", {"repeats": 1}, pace="fast")
        assert runner.wait(PATIENCE_S)
        assert process_of(runner) != killed


def test_sigterm_to_the_bench_process_stops_the_joint_first(runner, store):
    experiment_id = set_going(runner)
    os.kill(process_of(runner), signal.SIGTERM)
    assert runner.wait(PATIENCE_S)
    record = store.experiment(experiment_id)
    assert (record.outcome, record.reason) == ("stopped", f"trial 'step-001': {process.TERMINATED}")


SERVICE = """
import sys, time
from pathlib import Path
from bench.runs.bench_process.remote_runner import RemoteRunner
from bench.store import Store
from tests.runs.test_bench_process import configured

with Store.open(f"sqlite:///{sys.argv[1]}") as store:
    runner = RemoteRunner(configured(Path(sys.argv[1])), store)
    runner.start("steps", {"repeats": 3}, pace="real-time")
    while len(runner.live().rows) < 20:
        time.sleep(0.01)
    print(runner._supervisor.child().process_id, flush=True)
    time.sleep(600)
"""


def test_no_orphan_is_left_when_the_service_is_killed(tmp_path):
    database = tmp_path / "bench.sqlite"
    words = [sys.executable, "-c", SERVICE, str(database)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, cwd=Path(__file__).parents[2]) as service:
        assert service.stdout is not None
        bench = int(service.stdout.readline())
        assert is_there(bench)
        service.kill()
    wait_for(lambda: not is_there(bench))
    with Store.open(f"sqlite:///{database}") as store:
        [record] = store.experiments()
        [trial] = store.trials()
        assert (record.outcome, record.reason) == ("stopped", f"trial 'step-001': {process.ORPHAN}")
        assert store.samples(trial.id, ["enabled"])["enabled"][-1] == 0.0


def test_software_that_was_updated_under_a_running_service_is_named(tmp_path):
    with (
        Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store,
        closing(RemoteRunner(configured(tmp_path / "bench.sqlite"), store, "tests.runs.updated_process")) as runner,
        pytest.raises(BenchProcessError, match=r"process, 99.*updated under a running service"),
    ):
        runner.start("steps", {})


def test_a_store_that_the_bench_process_cannot_open_is_named(tmp_path):
    with (
        Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store,
        closing(RemoteRunner(configured(tmp_path / "gone" / "bench.sqlite"), store)) as runner,
        pytest.raises(StoreFileError, match="gone does not exist"),
    ):
        runner.start("steps", {})


def test_a_process_that_hangs_up_before_it_is_greeted_is_waited_for(monkeypatch):
    started, start = [], subprocess.Popen

    def noted(*words, **options):
        started.append(start(*words, **options))
        return started[-1]

    def hung_up(*_):
        raise NotBegunError("the bench process has ended")

    monkeypatch.setattr(subprocess, "Popen", noted)
    monkeypatch.setattr(Child, "_send", hung_up)
    with tempfile.TemporaryFile() as stop_file, pytest.raises(NotBegunError):
        Child(stop_file.fileno(), None)
    assert started[0].returncode is not None


def test_close_stops_and_nothing_starts_afterwards(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        runner = RemoteRunner(configured(tmp_path / "bench.sqlite"), store)
        experiment_id = runner.start("steps", {}, pace="real-time")
        bench = process_of(runner)
        runner.close()
        runner.close()
        assert not is_there(bench)
        assert store.experiment(experiment_id).reason.endswith("the bench was closed")
        with pytest.raises(BusyError, match="closed"):
            runner.start("steps", {})


# without a process


@pytest.mark.parametrize(
    "error",
    [
        DriveConnectionError("can0 node 5", "no answer in 0.3 s"),
        UnknownKindError("there is no 'jump'"),
        OSError(28, "No space left on device"),
        LimitError("load_kg is 5 kg", OutOfRange("load_kg", 5.0, "kg", high=0.1)),
    ],
)
def test_errors_are_the_same_on_the_other_side(error):
    found = error_of(failure_of(1, error))
    assert (type(found), str(found)) == (type(error), str(error))
    for name in ("device", "out_of_range"):
        assert vars(found).get(name) == getattr(error, name, None)


def test_the_first_reason_since_the_start_is_the_one_that_counts():
    line, file = StopLine.make()
    other = StopLine(file)  # as the other process has it
    line.ask("before")
    stop = LineStop(other, other.settled())
    assert not stop.is_set()
    line.ask("cable is caught " + "ä" * 2000)
    for _ in range(5):
        line.ask("later")
    assert stop.is_set()
    assert stop.reason.startswith("cable is caught ää")
    os.close(file)


def test_a_stop_without_a_reason_has_the_usual_one():
    line, file = StopLine.make()
    stop = LineStop(line, line.settled())
    line.ask()
    assert stop.is_set()
    assert stop.reason == "stop was asked for"
    os.close(file)
