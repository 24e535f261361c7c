"""Every route against its own description, with requests that fit it and requests that do not."""

import os

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis import GenerationMode
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.service.running_service import TOKEN

CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]
EXAMPLES = int(os.environ.get("SCHEMA_EXAMPLES", "4"))  # of a route, either way; a larger run: make schema
HEADERS = {"Authorization": f"Bearer {TOKEN}"}
LEFT_OUT = {
    "/api/v1/live": "get",  # has no end: test_live.py is for it
    "/api/v1/challenges": "post",  # records for a minute: test_challenges.py is for it
}
TAGS = [
    "audit",
    "bench",
    "calibrations",
    "challenges",
    "commission",
    "effects",
    "experiments",
    "lease",
    "live",
    "queue",
    "recording sets",
    "studies",
    "trials",
]


@schemathesis.serializer("application/zip")
def bytes_as_they_are(_context, value):
    return value if isinstance(value, bytes) else str(value).encode(errors="replace")


@pytest.fixture(scope="module")
def recorded(service):
    """Something to read: with it, small numbers in paths name what is there."""
    assert service.runner.wait(90.0)
    service.run("steps", repeats=1)
    return service


@pytest.fixture(scope="module")
def operations(recorded):
    document = recorded.client.get("/openapi.json").json()
    for path, method in LEFT_OUT.items():
        del document["paths"][path][method]
    loaded = schemathesis.openapi.from_dict(document)
    loaded.config.update(base_url=recorded.url)
    return [found.ok() for found in loaded.get_all_operations()]


def test_every_tag_is_asked_below(operations):
    assert {tag for operation in operations for tag in operation.tags} == set(TAGS)


@pytest.mark.parametrize("mode", list(GenerationMode), ids=lambda mode: mode.value)
@pytest.mark.parametrize("tag", TAGS)
def test_what_is_answered_is_declared(operations, recorded, tag, mode):
    for operation in operations:
        if tag in operation.tags:
            ask(operation, mode, recorded)


def ask(operation, mode, recorded) -> None:
    """Send what the schema says, or what it forbids; the joint stands still afterwards."""

    @given(case=operation.as_strategy(generation_mode=mode))
    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        derandomize=True,
        phases=[Phase.explicit, Phase.generate],
    )
    def send(case) -> None:
        try:
            case.call_and_validate(headers=HEADERS, checks=CHECKS, timeout=30)
        finally:
            recorded.client.post("/queue/pause")
            recorded.client.delete("/queue")
            recorded.runner.stop("the next request comes")
            assert recorded.runner.wait(90.0)

    send()
