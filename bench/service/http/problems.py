"""Errors as problem+json (RFC 9457): what went wrong, where, what is allowed, and what to do next."""

import json
import math
from collections.abc import Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.encoders import jsonable_encoder
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import JSONResponse

from bench.config.quantities import unit_of
from bench.config.validation import keys_beside, models_in, unknown_key
from bench.errors import BenchError
from bench.json_types import Values
from bench.runs.lease import LeaseHeldError
from compensator.errors import CompensatorError
from drivers.errors import DriveError

MEDIA_TYPE = "application/problem+json"
MISSING = "missing; give a value"
LONGEST_FOUND = 200  # characters that are said back of what was sent


class ProblemResponse(JSONResponse):
    """JSON in ASCII alone: a problem quotes what was sent, also what cannot be encoded (a lone surrogate)."""

    media_type = MEDIA_TYPE

    def render(self, content: Any) -> bytes:
        """The body."""
        return json.dumps(content, allow_nan=False, separators=(",", ":")).encode("ascii")


class FieldProblem(BaseModel):
    """One field that was not as wanted."""

    field: str = Field(description="path of the field, parts joined with '.'", examples=["parameters.load_kg"])
    message: str = Field(description="what is wanted", examples=["Input should be less than or equal to 0.1"])
    found: Any = Field(default=None, description="what was sent")
    allowed: dict[str, Any] = Field(
        default={},
        description="the bounds that apply, and the `margin` that they keep from the limits of the bench; "
        "of an unknown key, the known ones",
        examples=[{"le": 0.1}],
    )
    unit: str = Field(default="", description="SI unit of the field", examples=["kg"])


class Problem(BaseModel):
    """Problem details (RFC 9457). `detail` is one sentence for a person, `errors` the same field by field."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {
                    "type": "about:blank",
                    "title": "Unprocessable Content",
                    "status": 422,
                    "detail": "parameters.load_kg is 5; Input should be less than or equal to 0.1 kg",
                    "kind": "ParameterError",
                    "errors": [],
                }
            ]
        }
    )
    type: str = "about:blank"
    title: str
    status: int
    detail: str
    kind: str = Field(default="", description="name of the error's class in this software, for programs")
    errors: list[FieldProblem] = []


MEANINGS = {
    401: "the token is missing or wrong",
    403: "the role of the token does not allow it, or the request comes from another web page",
    404: "there is no such thing",
    408: "the body did not come in time",
    409: "it does not fit the present state (an experiment is running, somebody else has the bench)",
    413: "the body, or the upload, is too large",
    415: "the body is not of the wanted type",
    421: "the service does not answer to the name in `Host`",
    422: "a value is missing, of the wrong type or outside its range; nothing has moved",
    429: "too many wrong tokens came from this address; `Retry-After` says when the next is looked at",
    502: "the drive does not answer or reports a fault",
    503: "the store, or the disk, cannot be written or read now (locked, full, or not reached), what computed has been "
    "killed, or too many exports are under way (`Retry-After`)",
}


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The `responses` of a route: which problems it may answer with."""
    return {status: {"model": Problem, "description": MEANINGS[status]} for status in statuses}


def problem_response(
    status: int,
    detail: str,
    kind: str = "",
    errors: Sequence[FieldProblem] = (),
    headers: dict[str, str] | None = None,
) -> JSONResponse:
    """The one way in which this service says no."""
    title = HTTPStatus(status).phrase
    body = Problem(title=title, status=status, detail=detail, kind=kind, errors=list(errors))
    return ProblemResponse(jsonable_encoder(body), status_code=status, headers=headers)


def status_of(error: Exception) -> int:
    """HTTP status of an error of ours, from its class."""
    if isinstance(error, LookupError):
        return 404
    if isinstance(error, ValueError):
        return 422
    if isinstance(error, DriveError):
        return 502
    # what the machine lacks: a lock that is not released, a full disk
    return 503 if isinstance(error, OSError) else 409


def field_problems(
    error: ValidationError | RequestValidationError, prefix: str = "", model: type[BaseModel] | None = None
) -> list[FieldProblem]:
    """pydantic's list of errors as ours.

    Args:
        error: as raised; of a request, the first part of each location ("body", "query") is left out.
        prefix: put before each field's path.
        model: what was read; with it, an unknown key has the known ones beside it.
    """
    skip = 1 if isinstance(error, RequestValidationError) else 0
    return [_field_problem(detail, prefix, detail["loc"][skip:], model) for detail in error.errors()]


def _field_problem(
    error: Any, prefix: str, location: tuple[int | str, ...], model: type[BaseModel] | None
) -> FieldProblem:
    name = ".".join(str(part) for part in (*([prefix] if prefix else []), *location))
    bounds = error.get("ctx", {}).items()
    allowed: Values = {key: value for key, value in bounds if isinstance(value, int | float | str)}
    found = error.get("input")
    if isinstance(found, str) and len(found) > LONGEST_FOUND:
        found = f"{found[:LONGEST_FOUND]} … ({len(found)} characters)"
    elif not isinstance(found, int | float | str | bool | None):
        found = type(found).__name__
    message = error["msg"]
    if error["type"] == "extra_forbidden":
        keys = keys_beside(model, location) if model is not None else []
        message, allowed = unknown_key(str(location[-1]), keys), {"keys": keys} if keys else {}
    elif error["type"] == "missing":
        found, message = None, MISSING
    unit = next((unit_of(part) for part in reversed(location) if isinstance(part, str)), "")
    return FieldProblem(field=name, message=message, found=found, allowed=dict(allowed), unit=unit)


class InvalidFieldsError(BenchError, ValueError):
    """Raised by a route when values are refused and it is known which fields they came in."""

    def __init__(self, message: str, kind: str, errors: list[FieldProblem]) -> None:
        super().__init__(message)
        self.kind = kind
        self.errors = errors


def install(app: FastAPI) -> None:
    """Make every error of the application a problem."""
    app.add_exception_handler(ClientDisconnect, _gone)

    @app.exception_handler(BenchError)
    @app.exception_handler(DriveError)
    @app.exception_handler(CompensatorError)
    async def ours(request: Request, error: Exception) -> JSONResponse:
        detail = str(error)
        if getattr(request.state, "caller", None) is None:  # where things are is for those who have a token
            detail = detail.replace(f"'{request.app.state.store.where}'", "of this service")
        return problem_response(status_of(error), detail, kind=type(error).__name__)

    @app.exception_handler(LeaseHeldError)
    async def held(_request: Request, error: LeaseHeldError) -> JSONResponse:
        left = {} if error.remaining_s is None else {"Retry-After": str(math.ceil(error.remaining_s))}
        return problem_response(409, str(error), kind="LeaseHeldError", headers=left)

    @app.exception_handler(InvalidFieldsError)
    async def invalid_fields(_request: Request, error: InvalidFieldsError) -> JSONResponse:
        return problem_response(422, str(error), error.kind, error.errors)

    @app.exception_handler(RequestValidationError)
    async def invalid_request(request: Request, error: RequestValidationError) -> JSONResponse:
        if (no_json := _no_json(request, error)) is not None:
            return problem_response(422, no_json, kind="ValidationError")
        return _invalid(field_problems(error, model=_body_model(request)))

    @app.exception_handler(ValidationError)
    async def invalid_value(_request: Request, error: ValidationError) -> JSONResponse:
        return _invalid(field_problems(error))

    @app.exception_handler(HTTPException)
    async def http(request: Request, error: HTTPException) -> JSONResponse:
        if error.status_code == 400:  # FastAPI's word for a body that is no text
            return problem_response(422, "the body is no JSON: it is not in UTF-8", kind="ValidationError")
        headers = dict(error.headers) if error.headers else None
        return problem_response(error.status_code, _detail(request, error), headers=headers)


async def _gone(_request: Request, _error: Exception) -> JSONResponse:
    # nobody reads it; without it the log would have a fault of the service for each line that breaks
    return problem_response(408, "the connection ended before the body was there; send it again")


def _body_model(request: Request) -> type[BaseModel] | None:
    """What the route of a request reads its body into; None where it has none."""
    field = getattr(request.scope.get("route"), "body_field", None)
    return None if field is None else next(models_in(field.field_info.annotation), None)


def _detail(request: Request, error: HTTPException) -> str:
    """What a route says; of a route that there is not, which there are."""
    if error.detail != HTTPStatus(error.status_code).phrase:
        return str(error.detail)
    path = request.url.path[:LONGEST_FOUND]
    return f"there is no {request.method} {path}; GET {request.app.openapi_url} lists every route"


def _no_json(request: Request, error: RequestValidationError) -> str | None:
    """What is wrong with a body that is no JSON, or is not said to be; None where it is."""
    for detail in error.errors():
        if detail["type"] == "json_invalid":
            return f"the body is no JSON: {detail['ctx']['error']}, at character {detail['loc'][-1]}"
        if detail["loc"] == ("body",) and isinstance(detail["input"], bytes):  # handed on as it came
            return _no_json_type(request)
    return None


def _no_json_type(request: Request) -> str:
    """What is wrong with a body that was not read as JSON, since its header does not say that it is."""
    found = request.headers.get("content-type")
    said = "there is no Content-Type" if found is None else f"Content-Type is {found[:LONGEST_FOUND]!r}"
    return f"the body is not read as JSON: {said}; send 'Content-Type: application/json'"


def _invalid(errors: list[FieldProblem]) -> JSONResponse:
    sentences = [
        f"{error.field or 'body'}{'' if error.message == MISSING else f' is {error.found!r}'}: {error.message}"
        for error in errors
    ]
    return problem_response(422, "; ".join(sentences), kind="ValidationError", errors=errors)
