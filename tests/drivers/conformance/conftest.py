from collections.abc import Iterator

import pytest

from tests.drivers.conformance.benches import BENCHES, Bench


@pytest.fixture(scope="module", params=BENCHES)
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
