"""STOP, and what a start that came before it may still do: nothing.

A start waits for a thread, a drive or a disk, and STOP waits for none of these: one that was asked for later may be
answered first. What it was answered holds, whatever begins after it.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

from fastapi import Depends, FastAPI, Request

from bench.errors import BusyError

LATE = "STOP was asked for while this was being started"


def install(app: FastAPI) -> None:
    """None was asked for yet."""
    app.state.stops = 0


def stop_all(app: FastAPI, reason: str) -> None:
    """Stop the joint, and hold or end all that would move it next. Never waits. On the event loop."""
    app.state.stops += 1
    stop_what_runs(app, reason)


def stop_what_runs(app: FastAPI, reason: str) -> None:
    """The same from any thread, for a STOP that was counted already."""
    for one in (app.state.conductor, app.state.guide, app.state.calibrator, app.state.runner):
        one.stop(reason)


class StopsSince:
    """STOPs that were asked for since a request came. Made on the event loop, before anything is waited for."""

    def __init__(self, app: FastAPI) -> None:
        self._app = app
        self._before = app.state.stops

    @contextmanager
    def starting(self) -> Iterator[None]:
        """Around what begins to move the joint: it does not begin after a STOP, and is ended by one meanwhile.

        Raises:
            BusyError: STOP was asked for since the request came.
        """
        if self._are_there():
            raise BusyError("STOP was asked for after this request had come, so nothing was begun; send it again")
        yield
        if self._are_there():
            stop_what_runs(self._app, LATE)

    def _are_there(self) -> bool:
        return bool(self._app.state.stops != self._before)


async def _since(request: Request) -> StopsSince:
    return StopsSince(request.app)


StopsOf = Annotated[StopsSince, Depends(_since)]
