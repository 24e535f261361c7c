from collections.abc import Iterator

import pytest

from tests.drivers.conformance.benches import BENCHES, Bench


@pytest.fixture(scope="session", params=BENCHES)
def running(request: pytest.FixtureRequest) -> Iterator[Bench]:
    with BENCHES[request.param]() as made:
        yield made


@pytest.fixture
def bench(running: Bench) -> Iterator[Bench]:
    """The bench of one driver, left whole for the next test."""
    yield running
    running.repair()


@pytest.fixture
def wired(bench: Bench) -> Bench:
    """Only those benches that have a wire."""
    if bench.device is None:
        pytest.skip("in process there is no wire")
    return bench


@pytest.fixture
def watched(wired: Bench) -> Bench:
    """Of these, only those whose drive stops by itself when its host falls silent; for the others `test_unwatched`."""
    if not wired.variant.has_watchdog:
        pytest.skip("it has no watchdog")
    return wired


@pytest.fixture
def unwatched(wired: Bench) -> Bench:
    """Only the others."""
    if wired.variant.has_watchdog:
        pytest.skip("it has a watchdog")
    return wired
