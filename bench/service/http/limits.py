"""What a request may bring: how much, how deep, how fast. Refused before anything is parsed, so that STOP stays quick.

A body of JSON is small here; recordings are streamed into a file by their own route, and not looked at in this place.
"""

import asyncio
from dataclasses import dataclass

import anyio
import anyio.to_thread
import numpy as np
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from bench.service.auth.access import Access
from bench.service.http.api_router import PREFIX
from bench.service.http.guard import SAFE_METHODS
from bench.service.http.problems import problem_response

MOST_BYTES = 2**18  # of a body of JSON: ten times what the largest campaign has
MOST_WITH_TEXT = 2**22  # of one with a waveform: its text may be long, all beside it is as small as elsewhere
MOST_DEPTH = 32  # lists and objects within each other
MOST_PARTS = 2**13  # lists and objects in all: each is an object that the interpreter's collector walks over
MOST_DIGITS = 400  # of a number: beyond a float's range and Python's own limit for integers
LONGEST_S = 10.0  # until the body is here
WITH_TEXT = ("/experiments", "/experiments/plan")
UNREAD = (
    "/stop",
    "/recording-sets",
    "/recording-sets/guess",
)  # routes that wait for no body, or write it to a file as it comes
_QUOTE, _DIGIT, _OPENS, _CLOSES = (
    bytes(one in kind for one in range(256)) for kind in (b'"', b"0123456789", b"[{", b"]}")
)
_TOO_LONG = b"\1" * (MOST_DIGITS + 1)


@dataclass(frozen=True)
class _Refusal(Exception):
    status: int
    detail: str


class Limits:
    """ASGI middleware: reads the body of a request that may change something, and refuses what is too much.

    Whoever has no token is answered without his body being read.
    """

    def __init__(self, app: ASGIApp, access: Access, longest_s: float = LONGEST_S) -> None:
        self._app = app
        self._access = access
        self._longest_s = longest_s
        self._long = anyio.CapacityLimiter(1)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, or pass on with the body at hand."""
        if scope["type"] != "http" or scope["method"] in SAFE_METHODS:
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        try:
            known = await self._known(scope, headers)
        except HTTPException as refusal:
            refused = problem_response(refusal.status_code, refusal.detail, headers=dict(refusal.headers or {}))
            await refused(scope, receive, _closing(send))
            return
        if not known:
            await self._app(scope, _given(b"", receive), _closing(send))
            return
        if scope["path"].rstrip("/").endswith(UNREAD):
            await self._app(scope, receive, send)
            return
        try:
            most = MOST_WITH_TEXT if scope["path"].removeprefix(PREFIX) in WITH_TEXT else MOST_BYTES
            body = await self._body(headers, receive, most)
        except _Refusal as refusal:
            await problem_response(refusal.status, refusal.detail)(scope, receive, _closing(send))
            return
        await self._app(scope, _given(body, receive), send)

    async def _known(self, scope: Scope, headers: Headers) -> bool:
        """Whether it brings a token of this service. A wrong one is counted, whether there is such a route or not."""
        kind, _, token = headers.get("authorization", "").partition(" ")
        if kind.lower() != "bearer" or not token.strip():
            return False
        client = scope.get("client")
        found = await self._access.caller(token.strip(), client[0] if client else "")
        scope.setdefault("state", {})["wrong_token"] = found is None
        return found is not None

    async def _body(self, headers: Headers, receive: Receive, most: int) -> bytes:
        told = headers.get("content-length", "")
        if told.isdecimal() and int(told[:20]) > most:
            raise _too_large(f"{told[:20]} bytes", most)
        try:
            async with asyncio.timeout(self._longest_s):
                body = await _received(receive, most)
        except TimeoutError:
            raise _Refusal(408, f"the body was not here after {self._longest_s:g} s; send it at once") from None
        if len(body) <= MOST_BYTES:
            check_json(body)
        else:
            await anyio.to_thread.run_sync(check_json, body, limiter=self._long)
        return body


def check_json(body: bytes) -> None:
    """Refuse JSON that no request of this service needs, in time that grows with its length alone.

    Raises:
        _Refusal: nested too deep, too many lists and objects, or a number of too many digits.
    """
    if len(body) <= MOST_DEPTH:
        return
    escaped = body.replace(b"\\\\", b"").replace(b'\\"', b"")  # the quotes that are left begin and end a text
    within = np.bitwise_xor.accumulate(_bytes_of(escaped, _QUOTE))
    if len(within) > MOST_BYTES and (beside := len(within) - np.count_nonzero(within)) > MOST_BYTES:
        raise _Refusal(
            413, f"the body has {beside} bytes beside its texts; allowed are {MOST_BYTES}. Send it in pieces"
        )
    if _TOO_LONG in (_bytes_of(escaped, _DIGIT) > within).tobytes():
        raise _Refusal(422, f"the body has a number of more than {MOST_DIGITS} digits; allowed are {MOST_DIGITS}")
    opens = _bytes_of(escaped, _OPENS) > within
    step = opens.view(np.int8) - (_bytes_of(escaped, _CLOSES) > within).view(np.int8)
    if np.cumsum(step, dtype=np.int32).max(initial=0) > MOST_DEPTH:
        raise _Refusal(422, f"the body has lists or objects more than {MOST_DEPTH} deep; allowed are {MOST_DEPTH}")
    if (found := np.count_nonzero(opens)) > MOST_PARTS:
        raise _Refusal(422, f"the body has {found} lists and objects; allowed are {MOST_PARTS}. Send it in pieces")


def _bytes_of(body: bytes, kind: bytes) -> np.ndarray:
    """1 at each byte of a kind, else 0."""
    return np.frombuffer(body.translate(kind), np.uint8)


async def _received(receive: Receive, most: int) -> bytes:
    parts: list[bytes] = []
    size, more = 0, True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            return b""
        parts.append(message.get("body", b""))
        size += len(parts[-1])
        if size > most:
            raise _too_large("more", most)
        more = message.get("more_body", False)
    return b"".join(parts)


def _too_large(found: str, most: int) -> _Refusal:
    return _Refusal(
        413,
        f"the body has {found}; allowed are {most} bytes. Recordings go to POST /recording-sets as a zip, a long "
        "waveform to POST /experiments",
    )


def _given(body: bytes, receive: Receive) -> Receive:
    """First the body, then whatever else comes: the client's going, for who waits for it."""
    told = False

    async def receiving() -> Message:
        nonlocal told
        if told:
            return await receive()
        told = True
        return {"type": "http.request", "body": body, "more_body": False}

    return receiving


def _closing(send: Send) -> Send:
    """The connection is closed after the answer: the rest of the body is not read."""

    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", []), (b"connection", b"close")]}
        await send(message)

    return sending
