"""The process of the control loop comes before others while the wall clock paces it, and never fails for it."""

import gc
import os
import subprocess
import sys
import threading
from itertools import count

import pytest

from bench.control import scheduling

pytestmark = pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="scheduling of Linux")


def is_permitted() -> bool:
    return scheduling.describe() == scheduling.REAL_TIME


@pytest.fixture
def other():
    """A thread that is there before, as those that talk to the service are."""
    over = threading.Event()
    thread = threading.Thread(target=over.wait)
    thread.start()
    yield thread.native_id
    over.set()
    thread.join()


def refuse(*_arguments):
    raise PermissionError(1, "Operation not permitted")


@pytest.mark.skipif(not is_permitted(), reason="SCHED_FIFO is not permitted here")
def test_every_thread_comes_before_others_and_goes_back(other):
    with scheduling.undisturbed(paced=True):
        assert [os.sched_getscheduler(thread) for thread in (0, other)] == [os.SCHED_FIFO] * 2
    assert [os.sched_getscheduler(thread) for thread in (0, other)] == [os.SCHED_OTHER] * 2


def test_what_takes_all_the_time_there_is_does_not(other):
    with scheduling.undisturbed(paced=False):
        assert [os.sched_getscheduler(thread) for thread in (0, other)] == [os.SCHED_OTHER] * 2


@pytest.mark.skipif(not is_permitted(), reason="nothing is permitted here")
def test_without_real_time_it_is_nicer_to_itself(monkeypatch, other):
    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    before = os.getpriority(os.PRIO_PROCESS, other)
    assert scheduling.describe().startswith("nice -10, as SCHED_FIFO is not permitted (it takes CAP_SYS_NICE")
    with scheduling.undisturbed(paced=True):
        assert os.getpriority(os.PRIO_PROCESS, other) == -10
    assert os.getpriority(os.PRIO_PROCESS, other) == before


def test_where_nothing_is_permitted_it_runs_all_the_same(monkeypatch, other):
    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    monkeypatch.setattr(os, "setpriority", refuse)
    assert scheduling.describe().startswith("ordinary: SCHED_FIFO is not permitted")
    with scheduling.undisturbed(paced=True):
        assert os.sched_getscheduler(other) == os.SCHED_OTHER


@pytest.mark.skipif(not is_permitted(), reason="SCHED_RR is not permitted here")
def test_what_somebody_has_chosen_stays():
    program = (
        "import os; from bench.control import scheduling; os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(3));\n"
        "with scheduling.undisturbed(True): print(os.sched_getscheduler(0) == os.SCHED_RR, scheduling.describe())"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True SCHED_RR 3, as it was started"


def test_what_is_there_is_looked_through_for_garbage_once_in_many_experiments(monkeypatch):
    monkeypatch.setattr(scheduling, "_ended", count(1))
    monkeypatch.setattr(scheduling, "EXPERIMENTS_A_SEARCH", 2)
    there = [[]]
    with scheduling.undisturbed(paced=False):
        assert gc.get_freeze_count() > 0
    assert not is_looked_through(there)
    with scheduling.undisturbed(paced=False):
        assert not is_looked_through(there)
    assert is_looked_through(there)
    gc.freeze()  # as it was before


def is_looked_through(one) -> bool:
    return any(other is one for other in gc.get_objects())
