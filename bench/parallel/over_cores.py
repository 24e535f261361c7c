"""The same work on many items: on all cores of this machine, or on a Dask cluster at an address that is told.

One interface, two executors. Whole benches and diagnoses are Python, and need a process each.

A Dask cluster needs the extra `cluster`. A worker that is lost has its items done again by another one; an item that
takes four workers with it is given up, as Dask's `distributed.scheduler.allowed-failures` says.
"""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.forkserver import ensure_running
from typing import Any, TypeVar

from bench.errors import BenchError

CONNECT_S = 10.0
WORKERS_S = 30.0  # workers of a cluster that is just starting come one after the other
Item = TypeVar("Item")
Result = TypeVar("Result")

# not forks of this process: threads do not survive a fork
_FORKS = get_context("forkserver")
IN_HAND = 3  # items under way or waiting, for each core: so many are in memory, however many there are


class ClusterError(BenchError, OSError):
    """Raised when a cluster cannot be used."""


@contextmanager
def cluster_executor(address: str) -> Iterator[tuple[Executor, int]]:
    """The workers of a cluster as one executor, and how many items they do at a time.

    Args:
        address: of the scheduler, with its protocol; never guessed, never read from a configuration of Dask.

    Raises:
        ClusterError: no address, the extra is not installed, nobody answers, or no worker is there.
    """
    if "://" not in address:
        raise ClusterError(
            f"--cluster is '{address}'; wanted is a scheduler's address, for instance tcp://10.0.0.5:8786"
        )
    try:
        from distributed import Client
    except ImportError as error:
        raise ClusterError(
            "a cluster needs the extra 'cluster', here and on its workers: pip install 'friction-bench[cluster]'"
        ) from error
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise ClusterError(
            f"cluster {address}: no scheduler answers within {CONNECT_S:g} s; start one with 'dask scheduler', or "
            "leave --cluster out"
        ) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=WORKERS_S)
        except TimeoutError as error:
            raise ClusterError(
                f"cluster {address}: it has no worker; start some with 'dask worker {address} --nthreads 1'"
            ) from error
        executor = client.get_executor(pure=False)
        try:
            yield executor, max(1, sum(client.nthreads().values()))
        finally:
            # what was wanted has come; an item whose worker was lost may never end for Dask, and nobody waits for it
            executor.shutdown(wait=False)


def over_cores(
    work: Callable[[Item], Result], items: Iterable[Item], workers: int | None = None, cluster: str | None = None
) -> Iterator[Result]:
    """Do the work on every item; the results come in the order of the items.

    An item carries all that its result depends on, its seed too: then the results are the same bytes with any number
    of workers, here or elsewhere.

    Args:
        work: a function of a module, so that another process finds it by its name.
        items: picklable; taken as they are needed.
        workers: processes; one for each core where left out. 0 and 1 work in this process.
        cluster: address of a Dask scheduler, whose workers are used instead.

    Raises:
        ClusterError: the cluster cannot be used.
        Exception: what the work raised on an item, when its turn comes.
    """
    early: dict[int, Future[Result]] = {}
    turn = 0
    for index, future in _ended(work, items, workers, cluster):
        early[index] = future
        while turn in early:
            yield early.pop(turn).result()
            turn += 1


def as_they_end(
    work: Callable[[Item], Result], items: Iterable[Item], workers: int | None = None, cluster: str | None = None
) -> Iterator[Result]:
    """As `over_cores`; results come as they are had."""
    for _, future in _ended(work, items, workers, cluster):
        yield future.result()


def start_early(module: str, workers: int | None = None, cluster: str | None = None) -> None:
    """Have another process import what the work needs, while this one reads the first items.

    Workers are forks of it, so that all of them together import once. `over_cores` does so by itself, but later.
    """
    if cluster is None and _count(workers) > 1:
        _FORKS.set_forkserver_preload([module])
        ensure_running()


def _count(workers: int | None) -> int:
    return (os.cpu_count() or 1) if workers is None else max(1, workers)


def _ended(
    work: Callable[[Item], Result], items: Iterable[Item], workers: int | None, cluster: str | None
) -> Iterator[tuple[int, Future[Result]]]:
    numbered = enumerate(items)
    start_early(work.__module__, workers, cluster)
    with _executor(workers, cluster) as (executor, cores):
        open_items: dict[Future[Result], int] = {}
        for index, item in numbered:
            open_items[executor.submit(work, item)] = index
            if len(open_items) >= IN_HAND * cores:
                yield from _next(open_items)
        while open_items:
            yield from _next(open_items)


def _next(open_items: dict[Future[Result], int]) -> Iterator[tuple[int, Future[Result]]]:
    """Those that ended meanwhile, at least one."""
    for future in wait(open_items, return_when=FIRST_COMPLETED).done:
        yield open_items.pop(future), future


@contextmanager
def _executor(workers: int | None, cluster: str | None) -> Iterator[tuple[Executor, int]]:
    """Who does the work, and on how many cores."""
    if cluster is not None:
        with cluster_executor(cluster) as found:
            yield found
        return
    count = _count(workers)
    if count == 1:
        yield _Here(), 1
        return
    pool = ProcessPoolExecutor(count, mp_context=_FORKS)
    try:
        yield pool, count
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


class _Here(Executor):
    """Works in this process, at once."""

    def submit(self, work: Callable[..., Result], /, *arguments: Any, **named: Any) -> Future[Result]:
        future: Future[Result] = Future()
        try:
            future.set_result(work(*arguments, **named))
        except Exception as error:
            future.set_exception(error)
        return future
