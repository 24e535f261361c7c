"""What is asked of the service, and how it answered: counted, and held against its own description."""

from collections import Counter
from typing import Any

import schemathesis
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.service.running_service import TOKEN, RunningService

CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]
LONGEST_S = 300.0  # these tests make way for others; and the first run of all compiles the plant
HEADERS = {"Authorization": f"Bearer {TOKEN}"}
LEFT_OUT = {
    "/api/v1/live": "get",  # has no end: test_live.py is for it
    "/api/v1/live/jobs/{job}/stream": "get",  # waits for a job that may come
    "/api/v1/challenges": "post",  # records for a minute: test_challenges.py is for it
}
ANSWERS: Counter[str] = Counter()
"""How many requests were answered, by class of the status: "2xx"."""


@schemathesis.serializer("application/zip")
def bytes_as_they_are(_context: Any, value: Any) -> bytes:
    return value if isinstance(value, bytes) else str(value).encode(errors="replace")


def described(service: RunningService) -> Any:
    """The service as its description has it."""
    document = service.client.get("/openapi.json").json()
    for path, method in LEFT_OUT.items():
        del document["paths"][path][method]
    loaded = schemathesis.openapi.from_dict(document)
    loaded.config.update(base_url=service.url)
    return loaded


def as_http(case: Any) -> Any:
    """The same without headers that say how the body is framed: what is no HTTP is answered before any route."""
    for name in [name for name in case.headers or {} if name.lower() in ("content-length", "transfer-encoding")]:
        del case.headers[name]
    return case


def count(response: Any) -> None:
    """Count an answer."""
    ANSWERS[f"{response.status_code // 100}xx"] += 1


def stand_still(service: RunningService) -> None:
    """Whatever was begun is over, and the queue is empty."""
    service.client.post("/queue/pause")
    service.client.delete("/queue")
    service.runner.stop("the next request comes")
    assert service.runner.wait(LONGEST_S)
