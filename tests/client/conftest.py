from collections.abc import Iterator

import pytest

from bench.client import Bench, Study
from tests.service.recorded_joint import recording_set_zip
from tests.service.running_service import TOKEN, RunningService, running_service


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    with running_service(tmp_path_factory.mktemp("client")) as running:
        running.run("steps", repeats=1)
        yield running


@pytest.fixture
def bench(service: RunningService) -> Iterator[Bench]:
    service.runner.stop("the next test begins")
    assert service.runner.wait(90.0)
    with Bench(service.url, TOKEN) as opened:
        yield opened


@pytest.fixture(scope="package")
def study(service: RunningService) -> Iterator[Study]:
    """Study 1: a joint whose equation is known."""
    headers = {"Content-Type": "application/zip"}
    answer = service.client.post("/recording-sets?name=known+joint", content=recording_set_zip(), headers=headers)
    with Bench(service.url, TOKEN) as bench:
        yield bench.new_study("arm", [answer.json()["experiment_id"]], hold_out=["amplitude_rad=0.9"])
