"""Exports: written in threads of their own, few at a time, and few of them kept for whoever has not read them yet.

Readers, who look something up, wait for no export. One that is not read holds its place, and its temporary copy, until
its connection ends; that is given up after a while.
"""

from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import anyio
import anyio.to_thread
from fastapi import FastAPI, HTTPException, Request, Response
from fastapi.responses import FileResponse, StreamingResponse
from starlette.types import Receive, Scope, Send

MOST_AT_ONCE = 8  # asked for, and not read to the end
MOST_WRITTEN = 2  # of them at a time
RETRY_S = 30  # what whoever is refused is told to wait


@dataclass(frozen=True)
class Export:
    """What is sent.

    Attributes:
        content: a file, or pieces that are made one after the other.
        headers: beside `Content-Disposition`.
        name: of the file, for whoever keeps it.
        done: removes what is not needed once it has been sent, or given up.
    """

    content: Path | Iterator[bytes]
    media_type: str
    headers: Mapping[str, str]
    name: str
    done: Callable[[], None] = lambda: None


class Exports:
    """How many are under way. Used on the event loop alone."""

    def __init__(self) -> None:
        self.writing = anyio.CapacityLimiter(MOST_WRITTEN)
        self._under_way = 0

    def take(self) -> None:
        """Begin one.

        Raises:
            HTTPException: 503, there are too many.
        """
        if self._under_way >= MOST_AT_ONCE:
            raise HTTPException(
                503,
                f"{self._under_way} exports are under way and not read to the end; allowed are {MOST_AT_ONCE} at a "
                f"time. Ask again in {RETRY_S} s",
                {"Retry-After": str(RETRY_S)},
            )
        self._under_way += 1

    def give_back(self) -> None:
        """It has been sent, or given up."""
        self._under_way -= 1


async def export(request: Request, write: Callable[[], Export]) -> Response:
    """Write an export in a thread, and answer with it.

    Raises:
        HTTPException: 503, too many are under way.
    """
    exports: Exports = request.app.state.exports
    exports.take()
    try:
        made = await anyio.to_thread.run_sync(write, limiter=exports.writing)
    except BaseException:
        exports.give_back()
        raise
    headers = {**made.headers, "Content-Disposition": f'attachment; filename="{made.name}"'}
    if isinstance(made.content, Path):
        sent: Response = FileResponse(made.content, media_type=made.media_type, headers=headers)
    else:
        pieces = _pieces(made.content, exports.writing)
        sent = StreamingResponse(pieces, media_type=made.media_type, headers=headers)
    return _Held(sent, exports, made.done)


class _Held(Response):
    """An answer that gives its place back, whatever becomes of it."""

    def __init__(self, sent: Response, exports: Exports, done: Callable[[], None]) -> None:
        self._sent, self._exports, self._done = sent, exports, done
        self.raw_headers, self.background, self.status_code = sent.raw_headers, None, sent.status_code

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            await self._sent(scope, receive, send)
        finally:
            self._exports.give_back()
            with anyio.CancelScope(shield=True):
                await anyio.to_thread.run_sync(self._done)


async def _pieces(content: Iterator[bytes], limiter: anyio.CapacityLimiter) -> AsyncIterator[bytes]:
    end: Any = object()
    while (piece := await anyio.to_thread.run_sync(next, content, end, limiter=limiter)) is not end:
        yield piece


def install(app: FastAPI) -> None:
    """None is under way."""
    app.state.exports = Exports()
