"""The lab of a service in processes of its own: the same answers, other programs first, and nothing left behind."""

import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.recording_set import import_recording_set, read_recording_set
from bench.service.lab import NICENESS, LabEndedError, LabHere, LabProcesses
from bench.store import Store
from bench.store.errors import NotFoundError
from bench.study.compare import compare
from bench.study.create import create_study, describe, list_studies
from bench.study.diagnose import diagnose
from tests.queue.waiting import wait_for
from tests.service.recorded_joint import recording_set_zip

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> str:
    return f"sqlite:///{tmp_path_factory.mktemp('lab') / 'bench.sqlite'}"


@pytest.fixture(scope="module")
def store(url) -> Iterator[Store]:
    with Store.open(url) as store:
        yield store


@pytest.fixture
def lab(store, url) -> Iterator[LabProcesses]:
    found = LabProcesses(url)
    yield found
    found.close()


@pytest.fixture(scope="module")
def experiment_id(store, tmp_path_factory) -> int:
    path = tmp_path_factory.mktemp("set") / "known.zip"
    path.write_bytes(recording_set_zip())
    return import_recording_set(store, read_recording_set(path, None, None), "known")


def children() -> set[int]:
    tasks = Path("/proc/self/task").glob("*/children")
    return {int(word) for task in tasks for word in task.read_text().split()}


def lab_processes() -> set[int]:
    return {one for one in children() if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()}


def test_it_answers_as_the_lab_of_this_process_does(lab, store, experiment_id):
    found = lab.call(create_study, "arm", [experiment_id], hold_out=["repeat=2"])
    here = LabHere(store)
    assert lab.call(list_studies) == here.call(list_studies)
    study_id = found.study_id
    assert lab.call(compare, study_id).model_dump_json() == here.call(compare, study_id).model_dump_json()


def test_its_errors_are_those_of_the_lab(lab):
    with pytest.raises(NotFoundError, match="99"):
        lab.call(describe, 99)
    assert lab.call(list_studies) is not None  # the process goes on


def test_it_lets_other_programs_go_first_and_is_used_again(lab):
    before = lab_processes()
    lab.call(list_studies)
    lab.call(list_studies)
    (process,) = lab_processes() - before
    ours = os.getpriority(os.PRIO_PROCESS, 0)
    assert os.getpriority(os.PRIO_PROCESS, process) == min(ours + NICENESS, 19)


def test_one_that_was_killed_is_said_and_another_one_answers(lab):
    before = lab_processes()
    lab.call(list_studies)
    (process,) = lab_processes() - before
    os.kill(process, signal.SIGKILL)
    wait_for(lambda: process not in lab_processes(), 10.0)
    with pytest.raises(LabEndedError, match="ask again"):
        lab.call(list_studies)
    assert lab.call(list_studies) is not None


def test_the_end_of_the_service_does_not_wait_for_a_search(lab, store, experiment_id):
    study_id = LabHere(store).call(create_study, "long", [experiment_id], hold_out=["repeat=2"]).study_id
    before = lab_processes()
    ended = []

    def search() -> None:
        try:
            while True:
                lab.call(diagnose, study_id)
        except LabEndedError:
            ended.append(True)

    thread = threading.Thread(target=search)
    thread.start()
    wait_for(lambda: lab_processes() - before, 30.0)
    lab.close()
    thread.join(10.0)
    assert ended
    assert not lab_processes() - before
    with pytest.raises(LabEndedError, match="ending"):
        lab.call(list_studies)
