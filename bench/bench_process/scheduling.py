"""How the bench process shares the machine: the control loop first."""

import gc
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext, suppress

SWITCH_INTERVAL_S = 0.0005
"""How long another thread of the process may keep the interpreter from the loop; Python's own is ten times that."""

PRIORITY = 10  # of SCHED_FIFO, 1 .. 99: above every ordinary program, below the kernel's own threads
REAL_TIME = f"SCHED_FIFO {PRIORITY}"


def prepare() -> None:
    """Once, when everything is imported: what is there now is never looked at again for garbage."""
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    gc.collect()
    gc.freeze()


def describe() -> str:
    """How the operating system schedules the control loop here, and why not better, for the record."""
    if not hasattr(os, "sched_setscheduler"):
        return "ordinary: this operating system has no SCHED_FIFO"
    try:
        with _real_time():
            return REAL_TIME
    except PermissionError:
        return "ordinary: SCHED_FIFO is not permitted (it takes CAP_SYS_NICE, or LimitRTPRIO of the service)"
    except OSError as error:
        return f"ordinary: SCHED_FIFO is refused ({error.strerror})"


@contextmanager
def undisturbed(paced: bool) -> Iterator[None]:
    """For the thread of the control loop, while an experiment runs: real-time priority where that is permitted.

    Threads that it starts have it too: the recorder holds the interpreter now and then, and must not be kept waiting
    with it by another program.

    Args:
        paced: whether the wall clock paces it; what takes all the time there is must not come before others.
    """
    gc.collect()
    gc.freeze()  # what the experiment makes itself is little, and soon looked through
    try:
        with _real_time_where_permitted() if paced else nullcontext():
            yield
    finally:
        gc.unfreeze()


@contextmanager
def _real_time_where_permitted() -> Iterator[None]:
    with ExitStack() as stack:
        with suppress(OSError, AttributeError):
            stack.enter_context(_real_time())
        yield


@contextmanager
def _real_time() -> Iterator[None]:
    _set(os.SCHED_FIFO, PRIORITY)
    try:
        yield
    finally:
        _set(os.SCHED_OTHER, 0)


def _set(policy: int, priority: int) -> None:
    """Of the calling thread (Linux)."""
    os.sched_setscheduler(0, policy, os.sched_param(priority))
