import asyncio
from collections.abc import Callable, Iterator
from functools import wraps
from typing import Any

import pytest

from tests.service.running_service import RunningService, running_service


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    with running_service(tmp_path_factory.mktemp("service")) as running, pytest.MonkeyPatch.context() as patch:
        for way in ("reading", "writing"):
            database = running.store._database
            patch.setattr(database, way, not_where_stop_is_heard(getattr(database, way)))
        yield running


def not_where_stop_is_heard(transaction: Callable[..., Any]) -> Callable[..., Any]:
    """The same, refused on an event loop: STOP would wait for the database."""

    @wraps(transaction)
    def checked(*args: Any, **kwargs: Any) -> Any:
        assert asyncio._get_running_loop() is None, "the store was asked on the event loop"
        return transaction(*args, **kwargs)

    return checked


@pytest.fixture
def idle(service: RunningService) -> RunningService:
    """The service with nothing running."""
    service.runner.stop("the next test begins")
    assert service.runner.wait(90.0)  # the first run of all compiles the plant
    return service
