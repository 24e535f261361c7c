"""The same work on a Dask cluster as on the cores of this machine; workers that are lost; clusters that are none."""

import os
import sys
import time

import pytest

from bench.parallel.over_cores import ClusterError, as_they_end, over_cores
from bench.store import Store
from bench.study.create import create_study
from bench.study.diagnosis.diagnose_many import diagnose_many
from tests.lab.synthetic import plans
from tests.parallel.items import after, squared, takes_its_worker_with_it_once
from tests.study.conftest import imported

pytestmark = pytest.mark.timeout(300)


@pytest.fixture(scope="module")
def address():
    """A scheduler and two workers on this machine, in processes of their own."""
    distributed = pytest.importorskip("distributed", reason="needs the extra `cluster`")
    wanted = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**wanted, scheduler_port=0, silence_logs=50) as made:
        yield made.scheduler_address


def test_results_are_those_of_this_machine_in_the_same_order(address):
    there = list(over_cores(squared, range(20), cluster=address))
    assert [square for square, _ in there] == [square for square, _ in over_cores(squared, range(20), workers=1)]
    assert os.getpid() not in {process for _, process in there}


def test_a_lost_worker_costs_no_result(address, tmp_path):
    marks = [tmp_path / ("x" * length) for length in range(1, 7)]
    for mark in (marks[0], *marks[3:]):  # two workers are lost
        mark.touch()
    assert sorted(as_they_end(takes_its_worker_with_it_once, marks, cluster=address)) == [1, 2, 3, 4, 5, 6]
    assert all(mark.exists() for mark in marks)


def test_an_error_of_an_item_is_told(address):
    with pytest.raises(ValueError, match="-1 is below 0"):
        list(over_cores(squared, [2, -1], cluster=address))


def test_an_address_is_never_guessed():
    for text in ("", "here", "10.0.0.5:8786"):
        with pytest.raises(ClusterError, match="wanted is a scheduler's address"):
            list(over_cores(squared, [1], cluster=text))


def test_a_cluster_that_does_not_answer_is_named(monkeypatch):
    pytest.importorskip("distributed", reason="needs the extra `cluster`")
    monkeypatch.setattr("bench.parallel.over_cores.CONNECT_S", 0.2)
    with pytest.raises(ClusterError, match=r"tcp://127\.0\.0\.1:9: no scheduler answers"):
        list(over_cores(squared, [1], cluster="tcp://127.0.0.1:9"))


def test_without_the_extra_it_is_said_how_to_have_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ClusterError, match="pip install 'friction-bench\\[cluster\\]'"):
        list(over_cores(squared, [1], cluster="tcp://127.0.0.1:8786"))


def test_diagnoses_are_the_same_as_here(address, tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        experiment = imported(store, plans(loads_kg=(0.0, 0.2), repeats=1))
        made = [create_study(store, name, [experiment], cutoff_hz=6.0).study_id for name in ("one", "two")]
        shown = []
        there = diagnose_many(store, made, lambda *done: shown.append(done), cluster=address)
        assert there == diagnose_many(store, made, lambda *_: None, workers=1)
        assert shown[-1] == (2, 2)


def test_who_leaves_early_does_not_wait_for_what_still_runs(address):
    """Last in this file: a worker of its cluster is busy for a while afterwards."""
    results = as_they_end(after, [0.0, 30.0], cluster=address)
    assert next(results) == 0.0
    began = time.monotonic()
    results.close()
    assert time.monotonic() - began < 20.0
