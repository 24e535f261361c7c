"""How the process of the control loop shares the machine: the control loop first."""

import gc
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from itertools import count
from typing import NamedTuple

SWITCH_INTERVAL_S = 0.0001
"""How long another thread of the process may keep the interpreter from the loop; Python's own is fifty times that.

Shorter than the clock spins before a deadline: a loop that finds the interpreter taken when it wakes is in time."""

PRIORITY = 10  # of SCHED_FIFO, 1 .. 99: above every ordinary program, below the kernel's own threads
NICENESS = -10  # -20 .. 19: less is more of the processor
REAL_TIME = f"SCHED_FIFO {PRIORITY}"
HOW = "it takes CAP_SYS_NICE, or LimitRTPRIO of the service"
EXPERIMENTS_A_SEARCH = 50
"""After so many experiments, everything is looked through for garbage once more."""

_ended = count(1)  # experiments of this process


class _Way(NamedTuple):
    """A way to come before other programs; both functions take a thread's number (Linux).

    Attributes:
        take: raises `OSError` where that is not permitted.
    """

    name: str
    take: Callable[[int], None]
    give_back: Callable[[int], None]


def _ways() -> Iterator[_Way]:
    """Those that this operating system has, the best first."""
    if hasattr(os, "sched_setscheduler"):
        yield _Way(
            REAL_TIME,
            lambda thread: os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(PRIORITY)),
            lambda thread: os.sched_setscheduler(thread, os.SCHED_OTHER, os.sched_param(0)),
        )
    if hasattr(os, "setpriority") and sys.platform == "linux":  # elsewhere it is of processes, not of threads
        before = os.getpriority(os.PRIO_PROCESS, 0)
        yield _Way(
            f"nice {NICENESS}, as SCHED_FIFO is not permitted ({HOW})",
            lambda thread: os.setpriority(os.PRIO_PROCESS, thread, NICENESS),
            lambda thread: os.setpriority(os.PRIO_PROCESS, thread, before),
        )


def _permitted() -> _Way | None:
    """The best way that the operating system permits; None where it is to stay as it is."""
    if _chosen():
        return None
    for way in _ways():
        with suppress(OSError):
            way.take(0)
            way.give_back(0)
            return way
    return None


def _chosen() -> str:
    """The scheduling that somebody has given this process (`chrt`); "" where it is the ordinary one."""
    names = {"SCHED_FIFO", "SCHED_RR"}
    found = {getattr(os, name): name for name in names if hasattr(os, name)}
    policy = os.sched_getscheduler(0) if found else -1
    return f"{found[policy]} {os.sched_getparam(0).sched_priority}" if policy in found else ""


def prepare() -> None:
    """Once, when everything is imported: what is there now is hardly ever looked through for garbage again."""
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    gc.collect()
    gc.freeze()


def describe() -> str:
    """How the operating system schedules the control loop here, and why not better, for the record."""
    if chosen := _chosen():
        return f"{chosen}, as it was started"
    if (way := _permitted()) is not None:
        return way.name
    return f"ordinary: SCHED_FIFO is not permitted ({HOW})" if list(_ways()) else "ordinary: there is no other here"


@contextmanager
def undisturbed(paced: bool) -> Iterator[None]:
    """Real-time priority while an experiment runs, where that is permitted.

    All threads of the process get it, and those that they start. The control loop waits for whichever of them holds the
    interpreter, so a thread without priority would delay the loop, too.

    Args:
        paced: whether the wall clock paces the loop; a loop that never sleeps must not have priority.
    """
    gc.collect()
    gc.freeze()  # what the experiment makes itself is little, and soon looked through
    try:
        with _before_others() if paced else nullcontext():
            yield
    finally:
        # Nearly all of it stays for as long as the process does: each experiment would begin with a look through all
        # of it, for a sixth of a second. The little that has become garbage since, in circles, can wait.
        if next(_ended) % EXPERIMENTS_A_SEARCH == 0:
            gc.unfreeze()


@contextmanager
def _before_others() -> Iterator[None]:
    way = _permitted()
    if way is None:
        yield
        return
    _of_all_threads(way.take)
    try:
        yield
    finally:
        _of_all_threads(way.give_back)


def _of_all_threads(change: Callable[[int], None]) -> None:
    for thread in threading.enumerate():
        if thread.native_id is not None:
            with suppress(OSError):  # it has ended meanwhile
                change(thread.native_id)
