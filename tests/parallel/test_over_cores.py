"""The same work on many items, in processes."""

import os

import pytest

from bench.parallel.over_cores import over_cores


def _squared(item):
    if item < 0:
        raise ValueError(f"{item} is below 0")
    return item**2, os.getpid()


def test_results_come_in_order_and_from_other_processes():
    results = list(over_cores(_squared, range(8), workers=2))
    assert [square for square, _ in results] == [item**2 for item in range(8)]
    assert os.getpid() not in {process for _, process in results}


@pytest.mark.parametrize("workers", [0, 1])
def test_one_worker_works_here(workers):
    assert list(over_cores(_squared, [3], workers=workers)) == [(9, os.getpid())]


def _parent(_item):
    return os.getppid()


def test_workers_are_forks_of_a_process_that_has_imported_for_all_of_them():
    parents = set(over_cores(_parent, range(8), workers=2))
    assert len(parents) == 1
    assert parents != {os.getpid()}


def test_error_of_an_item_is_told():
    with pytest.raises(ValueError, match="-1 is below 0"):
        list(over_cores(_squared, [2, -1], workers=2))
