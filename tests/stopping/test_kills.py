"""A few of the ways a run can end; `make kills` goes through all of them many times."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.stopping.bench import kills_bench
from tests.stopping.kills import Killer
from tests.stopping.laboratory import laboratory
from tests.stopping.ways import WAYS

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
CHOSEN = ("stop by REST", "limit trip", "drive gone", "kill -9 of the loop", "kill -9 of the service")


@pytest.fixture(scope="module", params=[1, 2], ids=["one joint", "a pair"])
def killer(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Killer]:
    """One store and the same drives for all: that the next run starts is part of the test."""
    with kills_bench(tmp_path_factory.mktemp("kills"), request.param) as bench:
        made = Killer(bench, seed=1)
        yield made
        made.leave()


@pytest.mark.timeout(300)  # processes take their time to start where others want the machine, too
@pytest.mark.parametrize("way", [way for way in WAYS if way.name in CHOSEN], ids=lambda way: way.name)
def test_what_was_committed_is_there_the_motor_off_and_the_record_says_why(killer: Killer, way) -> None:
    ending = killer.end_one(way)
    assert ending.problems == []
    assert ending.rows > 0


@pytest.mark.timeout(300)
def test_a_stop_from_another_terminal_ends_a_run_in_power_off(tmp_path: Path) -> None:
    (way,) = (way for way in WAYS if way.name == "run: stop from another terminal")
    with kills_bench(tmp_path) as bench:
        made = Killer(bench, seed=3)
        try:
            ending = made.end_one(way)
        finally:
            made.leave()
    assert ending.problems == []
    assert ending.rows > 0


@pytest.mark.timeout(300)
def test_what_a_killed_service_recorded_comes_to_a_laboratory_that_breaks_down_itself(
    tmp_path: Path,
) -> None:
    (way,) = (way for way in WAYS if way.name == "kill -9 of the service")
    with laboratory(seed=2) as lab, kills_bench(tmp_path, lab_url=lab.link.url) as bench:
        made = Killer(bench, seed=2)
        try:
            assert made.end_one(way).problems == []
        finally:
            made.leave()
        assert lab.held_against(bench.records.url, bench.configuration.name)[:2] == (0, 0)
