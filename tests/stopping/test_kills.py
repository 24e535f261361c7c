"""A few of the ways a run can end; `make kills` goes through all of them many times."""

import os

import numpy as np
import pytest

from tests.stopping.kills import WAYS, Bench, end_one

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
CHOSEN = ("kill -9 of the run", "kill -9 of the service", "disk full")


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """One store for all: that the next run starts is part of the test."""
    return Bench(tmp_path_factory.mktemp("kills"))


@pytest.mark.timeout(400)  # each starts a process of its own, which a loaded machine takes its time for
@pytest.mark.parametrize("way", [way for way in WAYS if way.name in CHOSEN], ids=lambda way: way.name)
def test_what_was_committed_is_there_and_the_record_says_why(bench: Bench, way) -> None:
    ending = end_one(bench, way, np.random.default_rng(len(way.name)))
    assert ending.problems == []
    assert ending.rows > 0
