"""How long an ordinary process waits for its turn of the processor meanwhile: what a row of the benchmark hangs on.

A pseudo-terminal is emptied by ordinary threads of the kernel. Where they have to wait, so has every frame on it.
"""

import multiprocessing
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection

LONG_S = 0.02  # a SYNC that is not answered by then is given up
_NAP_S = 0.001


class Holes:
    """What was seen, once it is over.

    Attributes:
        longest_s: of all waits.
        long: how many were longer than `LONG_S`.
    """

    longest_s, long = 0.0, 0

    def __str__(self) -> str:
        longest_ms, long_ms = 1e3 * self.longest_s, 1e3 * LONG_S
        return f"an ordinary process waited {self.long} times for more than {long_ms:g} ms, up to {longest_ms:.0f} ms"


@contextmanager
def watched() -> Iterator[Holes]:
    """Watch an ordinary process for a while."""
    found, (ours, theirs) = Holes(), multiprocessing.Pipe()
    process = multiprocessing.get_context("spawn").Process(target=_nap, args=(theirs,), daemon=True)
    process.start()
    ours.recv()
    try:
        yield found
    finally:
        ours.send(None)
        found.longest_s, found.long = ours.recv()
        process.join()


def _nap(wire: Connection) -> None:
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    wire.send(None)
    longest_s, long, last_s = 0.0, 0, time.perf_counter()
    while not wire.poll():
        time.sleep(_NAP_S)
        now_s = time.perf_counter()
        longest_s, long, last_s = max(longest_s, now_s - last_s), long + (now_s - last_s > LONG_S), now_s
    wire.send((longest_s, long))
