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
MOST_AT_BENCH = 8  # they wait, and take no processor


async def in_worker(request: Request, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run a long computation in a thread; at most two at a time, further ones wait their turn.

    Args:
        request: the request that asked for it; its application holds the limiter.
        function: what to run; it must not touch the event loop.
        *args: passed on.
        **kwargs: passed on.
    """
    limiter = _limiter(request, "compute_limiter", MOST_AT_ONCE)
    return await anyio.to_thread.run_sync(lambda: function(*args, **kwargs), limiter=limiter)


async def at_bench(request: Request, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run what waits for the bench, as a start waits for its drive; those who only read do not stand behind it.

    Args:
        request: the request that asked for it; its application holds the limiter.
        function: what to run; it must not touch the event loop.
        *args: passed on.
        **kwargs: passed on.
    """
    limiter = _limiter(request, "bench_limiter", MOST_AT_BENCH)
    return await anyio.to_thread.run_sync(lambda: function(*args, **kwargs), limiter=limiter)


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


def _limiter(request: Request, name: str, most: int) -> anyio.CapacityLimiter:
    state: Any = request.app.state
    if not hasattr(state, name):
        setattr(state, name, anyio.CapacityLimiter(most))
    found: anyio.CapacityLimiter = getattr(state, name)
    return found
