from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.config.configuration import default_configuration
from bench.runs.queue.conductor import Conductor
from bench.runs.runner import Runner
from bench.store import Store
from tests.queue.waiting import wait_for


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


@pytest.fixture
def runner(store: Store) -> Iterator[Runner]:
    made = Runner(default_configuration(), store)
    yield made
    made.close()


@pytest.fixture
def conductor(runner: Runner, store: Store) -> Iterator[Conductor]:
    made = Conductor(runner, store)
    made.begin()
    yield made
    made.stop("the test has ended")
    runner.stop("the test has ended")
    made.close()
    wait_for(lambda: made.running is None)
