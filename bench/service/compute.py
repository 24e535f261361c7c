"""Fits and diagnoses are waited for here: in worker threads of their own, so that they never hold up STOP or the
readers."""

import asyncio
from collections.abc import Callable
from typing import Concatenate, ParamSpec, TypeVar

import anyio
import anyio.to_thread
from fastapi import FastAPI, Request

from bench.service.lab import Asker, Lab
from bench.service.live.jobs import Jobs
from bench.store import Store

P = ParamSpec("P")
T = TypeVar("T")
JOB_HEADER = "X-Job"
LONGEST_NAME = 100  # characters
MOST_AT_ONCE = 2
MOST_AT_BENCH = 8  # they wait, and take no processor
LOOK_EVERY_S = 0.25  # whether the one who asked is still there
RELOADED_S = 1.5  # a page that is loaded anew asks for the same again: what would be ready by then is not ended


async def in_worker(request: Request, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run a long computation in a thread, off the event loop; at most two at a time, further ones wait their turn."""
    limiter: anyio.CapacityLimiter = request.app.state.compute_limiter
    return await anyio.to_thread.run_sync(lambda: function(*args, **kwargs), limiter=limiter)


async def at_bench(request: Request, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Run what waits for the bench, as a start does for its drive; readers do not stand behind it. See `in_worker`."""
    limiter: anyio.CapacityLimiter = request.app.state.bench_limiter
    return await anyio.to_thread.run_sync(lambda: function(*args, **kwargs), limiter=limiter)


async def in_lab(
    request: Request, function: Callable[Concatenate[Store, P], T], /, *args: P.args, **kwargs: P.kwargs
) -> T:
    """What a function of `bench.study` returns. It is ended when the one who asked breaks the connection.

    A request with the header `X-Job` is a job of that name: /live/jobs tells how far it has come.

    Args:
        request: the request that asked for it; its application has the lab.
        function: of a module, so that another process finds it; takes the store first.
        *args: after the store.
        **kwargs: passed on.
    """
    lab: Lab = request.app.state.lab
    name = request.headers.get(JOB_HEADER, "")[:LONGEST_NAME]
    jobs: Jobs = request.app.state.jobs
    job = jobs.begin(name, function.__name__) if name else None
    asker = Asker(job.tell) if job else Asker()
    watch = asyncio.create_task(_give_up_when_gone(request, asker))
    try:
        return await in_worker(request, lab.call_for, asker, function, *args, **kwargs)
    finally:
        watch.cancel()
        if job:
            job.end()


async def _give_up_when_gone(request: Request, asker: Asker) -> None:
    while not await request.is_disconnected():
        await asyncio.sleep(LOOK_EVERY_S)
    await asyncio.sleep(RELOADED_S)
    await anyio.to_thread.run_sync(asker.give_up)


def install(app: FastAPI) -> None:
    """How many computations, and how many that wait for the bench, are under way at a time."""
    app.state.jobs = Jobs()
    app.state.compute_limiter = anyio.CapacityLimiter(MOST_AT_ONCE)
    app.state.bench_limiter = anyio.CapacityLimiter(MOST_AT_BENCH)
