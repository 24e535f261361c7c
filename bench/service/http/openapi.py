"""The interface's own description, completed with what holds for every route."""

import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from fastapi import FastAPI

from bench.service.http.problems import MEANINGS, MEDIA_TYPE, Problem

FILE = Path(__file__).with_name("examples.json")


@cache
def examples() -> dict[str, Any]:
    """By `key`."""
    found: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    return found


def key(method: str, path: str) -> str:
    """A route, whatever the numbers in its path are called: `GET /api/v1/trials/{}`."""
    return f"{method.upper()} {re.sub(r'{[a-z_]+}', '{}', path)}"


PROBLEM = {"$ref": "#/components/schemas/Problem"}
Document = dict[str, Any]
"""A part of an OpenAPI document, as FastAPI makes it."""
READING = (401, 429)  # where reading takes a token; a wrong Host is 421 everywhere
DETAILS = {
    401: "this needs a token, and no token was sent",
    403: "token 'ada' has the role viewer; this takes the role operator",
    404: "trial 77 is not in the store; list the trials to see which are",
    409: "the bench is held by Ada, room 12 (token 'ada') for another 41 s; wait, or ask an admin to take it over",
    408: "the body was not here after 10 s; send it at once",
    413: "the upload is larger than 2147483648 bytes; split the set, or import its path",
    415: "Content-Type is 'text/plain'; wanted is application/zip",
    421: "Host is 'evil.example'; this service answers to 127.0.0.1, ::1, localhost. Add a name with --allow-host",
    422: "load_kg is 5 kg; allowed is at most 0.1 kg",
    429: "too many wrong tokens came from 192.0.2.7; wait 6 s",
    502: "the drive does not answer within 0.1 s; look at its supply and its cable",
    503: "store 'bench.sqlite' is locked by another process for more than 10 s",
}


def install(app: FastAPI) -> None:
    """Complete the description when it is asked for the first time."""
    plain = app.openapi

    def complete() -> Document:
        if app.openapi_schema is None:
            document = plain()
            schemas = document["components"]["schemas"]
            schemas |= _problem_schemas()
            for path, method, route in _routes(document):
                _complete(path, method, route, schemas)
            for unused in ("HTTPValidationError", "ValidationError"):
                schemas.pop(unused, None)
        return dict(app.openapi_schema or {})

    app.openapi = complete  # type: ignore[method-assign]


def _routes(document: Document) -> Iterator[tuple[str, str, Document]]:
    for path, item in document["paths"].items():
        for method, route in item.items():
            yield path, method, route


def _problem_schemas() -> Document:
    found = Problem.model_json_schema(ref_template="#/components/schemas/{model}")
    return {**found.pop("$defs", {}), "Problem": found}


def _complete(path: str, method: str, route: Document, schemas: Document) -> None:
    """An example of what is answered; every problem as problem+json with one; those that may come from every route."""
    responses = route["responses"]
    recorded = examples().get(key(method, path))
    for status, answer in responses.items():
        said = answer.get("content", {}).get("application/json")
        if status.startswith("2") and said is not None and "example" not in said:
            example = recorded or _own_example(said.get("schema", {}), schemas)
            if example is not None:
                said["example"] = example
    statuses = {int(status) for status in responses if int(status) >= 400}
    statuses |= {421, 503}
    if "requestBody" in route:
        statuses |= {408, 413}
    if route.get("security"):
        statuses |= {*READING} if method == "get" else {*READING, 403}
    for status in sorted(statuses):
        responses[str(status)] = _problem(status)


def _own_example(schema: Document, schemas: Document) -> Any:
    """An answer made of the examples that a model gives for its fields; None where one of them has none."""
    try:
        return _example_of(schema, schemas)
    except _NoExampleError:
        return None


class _NoExampleError(Exception):
    """Raised for a field of which nothing is known but its type."""


def _example_of(schema: Document, schemas: Document) -> Any:
    if "examples" in schema:
        return schema["examples"][0]
    if schema.get("type") == "array":
        return [_example_of(schema["items"], schemas)]
    if {"type": "null"} in schema.get("anyOf", ()):
        return None
    fields = schemas.get(schema.get("$ref", "").rpartition("/")[2], {}).get("properties", {})
    if not fields:
        raise _NoExampleError
    return {name: _example_of(field, schemas) for name, field in fields.items()}


def _problem(status: int) -> Document:
    from http import HTTPStatus

    example = Problem(title=HTTPStatus(status).phrase, status=status, detail=DETAILS[status]).model_dump()
    found: Document = {
        "description": MEANINGS[status],
        "content": {MEDIA_TYPE: {"schema": PROBLEM, "example": example}},
    }
    if status in (409, 429):
        found["headers"] = {"Retry-After": {"schema": {"type": "integer"}, "description": "seconds"}}
    return found
