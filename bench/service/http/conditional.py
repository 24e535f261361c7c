"""Conditional GET (RFC 9110, section 13): what a client has already is not sent again."""

import hashlib
from typing import Any

from fastapi import FastAPI, Request, Response

from bench import __version__

HEADER = "If-None-Match"
FRESH = {"Cache-Control": "private, no-cache"}  # kept by the client alone, which asks each time whether it still holds
ANSWER: dict[int | str, dict[str, Any]] = {
    304: {"description": f"It is as the client has it: `{HEADER}` holds the `ETag` of an earlier answer. No body."}
}


class NotModifiedError(Exception):
    """Raised by a route when the client has the present answer."""

    def __init__(self, headers: dict[str, str]) -> None:
        super().__init__("not modified")
        self.headers = headers


def tag_of(*facts: object) -> str:
    """A weak tag for all that the answer depends on, the version of this software with it."""
    text = "\n".join(map(repr, (__version__, *facts)))
    return f'W/"{hashlib.sha256(text.encode(errors="backslashreplace")).hexdigest()[:32]}"'


def unless_known(request: Request, *facts: object) -> dict[str, str]:
    """The headers of an answer that depends on these facts alone.

    Raises:
        NotModifiedError: the client has it.
    """
    headers = {"ETag": tag_of(*facts), **FRESH}
    sent = [tag.strip() for tag in request.headers.get(HEADER, "").split(",")]
    if "*" in sent or headers["ETag"] in sent:
        raise NotModifiedError(headers)
    return headers


def install(app: FastAPI) -> None:
    """Answer 304."""

    @app.exception_handler(NotModifiedError)
    async def not_modified(_request: Request, error: NotModifiedError) -> Response:
        return Response(status_code=304, headers=error.headers)
