"""The lab of a service in processes of its own: the same answers, other programs first, and nothing left behind."""

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import numpy as np
import pytest
import uvicorn
from fastapi import FastAPI, Request

from bench.recording_set import import_recording_set, read_recording_set
from bench.service import compute
from bench.service.lab import FIRST_TO_GO, NICENESS, Asker, LabEndedError, LabHere, LabProcesses
from bench.service.server import Address, listen
from bench.service.uploads import guess_upload, import_upload
from bench.store import Store
from bench.store.errors import NotFoundError
from bench.study.compare import compare
from bench.study.create import create_study, describe
from bench.study.diagnosis.diagnose import diagnose
from tests.queue.waiting import wait_for
from tests.service.recorded_joint import recording_set_zip
from tests.service.running_service import running_service

pytestmark = [
    pytest.mark.skipif(os.name != "posix", reason="signals of POSIX"),
    pytest.mark.timeout(600),  # the lab lets other programs go first: on a busy machine it takes minutes
]


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> str:
    return f"sqlite:///{tmp_path_factory.mktemp('lab') / 'bench.sqlite'}"


@pytest.fixture(scope="module")
def store(url) -> Iterator[Store]:
    with Store.open(url) as store:
        yield store


@pytest.fixture(scope="module")
def others() -> set[int]:
    """Processes that are not this lab's."""
    return lab_processes()


@pytest.fixture(scope="module")
def lab(store, url, others) -> Iterator[LabProcesses]:
    """One for all: each of its processes takes seconds to start, and it starts another where one has ended."""
    found = LabProcesses(url)
    yield found
    found.close()


@pytest.fixture(scope="module")
def experiment_id(store, tmp_path_factory) -> int:
    path = tmp_path_factory.mktemp("set") / "known.zip"
    path.write_bytes(recording_set_zip())
    return import_recording_set(store, read_recording_set(path, None, None), "known")


def study_names(store: Store) -> list[str]:
    """A short question."""
    return [row.name for row in store.studies()]


def children() -> set[int]:
    tasks = Path("/proc/self/task").glob("*/children")
    return {int(word) for task in tasks for word in task.read_text().split()}


def lab_processes() -> set[int]:
    return {one for one in children() if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()}


def test_it_answers_as_the_lab_of_this_process_does(lab, store, experiment_id):
    found = lab.call_for(Asker(), create_study, "arm", [experiment_id], hold_out=["repeat=2"])
    here = LabHere(store)
    assert lab.call_for(Asker(), study_names) == here.call_for(Asker(), study_names)
    study_id = found.study_id
    theirs, ours = (one.call_for(Asker(), compare, study_id) for one in (lab, here))
    assert theirs.model_dump_json() == ours.model_dump_json()


def test_its_errors_are_those_of_the_lab(lab):
    with pytest.raises(NotFoundError, match="99"):
        lab.call_for(Asker(), describe, 99)
    assert lab.call_for(Asker(), study_names) is not None  # the process goes on


def test_it_lets_other_programs_go_first_and_is_used_again(lab, others):
    lab.call_for(Asker(), study_names)
    lab.call_for(Asker(), study_names)
    (process,) = lab_processes() - others
    ours = os.getpriority(os.PRIO_PROCESS, 0)
    assert os.getpriority(os.PRIO_PROCESS, process) == min(ours + NICENESS, 19)
    if (of_memory := Path(f"/proc/{process}/oom_score_adj")).exists():
        assert of_memory.read_text().strip() == FIRST_TO_GO


def test_one_that_was_killed_is_said_and_another_one_answers(lab, others):
    lab.call_for(Asker(), study_names)
    (process,) = lab_processes() - others
    os.kill(process, signal.SIGKILL)
    wait_for(lambda: process not in lab_processes(), 10.0)
    with pytest.raises(LabEndedError, match="ask again"):
        lab.call_for(Asker(), study_names)
    assert lab.call_for(Asker(), study_names)


def test_the_end_of_the_service_does_not_wait_for_a_search(url, store, experiment_id):
    lab = LabProcesses(url)
    study_id = LabHere(store).call_for(Asker(), create_study, "long", [experiment_id], hold_out=["repeat=2"]).study_id
    before = lab_processes()
    ended = []

    def search() -> None:
        try:
            while True:
                lab.call_for(Asker(), diagnose, study_id)
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
        lab.call_for(Asker(), study_names)


def test_what_is_given_up_is_ended_and_the_next_call_is_answered(lab, others):
    asker, failures = Asker(), []

    def wait_long() -> None:
        try:
            lab.call_for(asker, sleeping, 600.0)
        except LabEndedError as error:
            failures.append(error)

    thread = threading.Thread(target=wait_long)
    thread.start()
    wait_for(lambda: asker._end is not None)
    asker.give_up()
    thread.join(20.0)
    assert not thread.is_alive()
    assert len(failures) == 1
    assert lab_processes() <= others
    assert lab.call_for(Asker(), study_names)
    with pytest.raises(LabEndedError, match="has gone"):
        lab.call_for(asker, study_names)  # nor does it begin
    assert lab.call_for(Asker(), study_names)


def sleeping(_store: Store, time_s: float) -> None:
    """A long fit."""
    time.sleep(time_s)


def test_a_broken_connection_ends_what_was_computed_for_it(lab, others):
    """Through the service: the process of the lab is gone soon after the one who asked."""
    app = FastAPI()
    app.state.lab = lab
    compute.install(app)

    @app.get("/long")
    async def long(request: Request) -> None:
        await compute.in_lab(request, sleeping, 600.0)

    with served(app) as address:
        with pytest.raises(httpx.ReadTimeout):
            httpx.get(f"{address}/long", timeout=httpx.Timeout(5.0, read=2.0))
        wait_for(lambda: lab_processes() <= others)


@contextmanager
def served(app: FastAPI) -> Iterator[str]:
    with listen(Address("127.0.0.1", 0)) as listener:
        server = uvicorn.Server(uvicorn.Config(app, log_level="error"))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
        server.should_exit = True
        thread.join()


def all_memory(_store):
    return np.empty(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"), np.uint8).shape


@pytest.mark.skipif(sys.platform != "linux", reason="other systems bound less")
def test_one_that_wants_all_memory_is_refused_it_in_words(lab):
    with pytest.raises(LabEndedError, match="more memory"):
        lab.call_for(Asker(), all_memory)
    assert lab.call_for(Asker(), study_names) is not None


def test_files_of_others_are_read_by_the_lab(tmp_path, monkeypatch):
    """What hangs on a file, or takes all memory for it, is not the process that hears STOP."""
    called, call_for = [], LabHere.call_for

    def listening(self, asker, function, /, *args, **kwargs):
        called.append(function)
        return call_for(self, asker, function, *args, **kwargs)

    monkeypatch.setattr(LabHere, "call_for", listening)
    body, kind = recording_set_zip(), {"Content-Type": "application/zip"}
    with running_service(tmp_path) as service:
        for route in ("/recording-sets", "/recording-sets/guess"):
            service.client.post(f"{route}?name=joint", content=body, headers=kind).raise_for_status()
    assert called == [import_upload, guess_upload]
