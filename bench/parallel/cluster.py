"""A Dask cluster as an executor, by the address of its scheduler. Needs the extra `cluster`.

A worker that is lost has its items done again by another one; an item that takes four workers with it is given up, as
Dask's `distributed.scheduler.allowed-failures` says.
"""

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from bench.errors import BenchError

CONNECT_S = 10.0
WORKERS_S = 30.0  # workers of a cluster that is just starting come one after the other


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
