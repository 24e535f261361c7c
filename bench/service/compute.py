"""Fits and diagnoses are waited for here: in worker threads of their own, so that they never hold up STOP or the
readers."""

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import anyio
import anyio.to_thread
from fastapi import Request

from bench.service.lab import Lab

P = ParamSpec("P")
T = TypeVar("T")
MOST_AT_ONCE = 2


async def in_worker(request: Request, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run a long computation in a thread; at most two at a time, further ones wait their turn.

    Args:
        request: the request that asked for it; its application holds the limiter.
        function: what to run; it must not touch the event loop.
        *args: passed on.
        **kwargs: passed on.
    """
    state: Any = request.app.state
    if not hasattr(state, "compute_limiter"):
        state.compute_limiter = anyio.CapacityLimiter(MOST_AT_ONCE)
    return await anyio.to_thread.run_sync(lambda: function(*args, **kwargs), limiter=state.compute_limiter)


async def in_lab(request: Request, name: str, /, *args: Any, **kwargs: Any) -> Any:
    """What a function of `bench.study` returns.

    Args:
        request: the request that asked for it; its application has the lab.
        name: of the function.
        *args: after the store.
        **kwargs: passed on.
    """
    lab: Lab = request.app.state.lab
    return await in_worker(request, lab.call, name, *args, **kwargs)
