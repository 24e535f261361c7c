from collections.abc import Iterator

import pytest

from tests.service.running_service import RunningService, running_service


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    with running_service(tmp_path_factory.mktemp("service")) as running:
        yield running


@pytest.fixture
def idle(service: RunningService) -> RunningService:
    """The service with nothing running."""
    service.runner.stop("the next test begins")
    assert service.runner.wait(90.0)  # the first run of all compiles the plant
    return service
