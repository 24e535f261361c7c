"""Turns of the processor for what runs against the wall clock: a simulated device, and the host that drives it.

On a machine that is busy with other work a thread may wait 50 ms for its turn, where a drive's own processor never
does. A real-time priority, where the system grants one (root, or `rtprio` in limits.conf), takes that away; where it
does not, everything runs as it is.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress

_PRIORITY = 1  # the lowest of the real-time ones


def ask_for_turns(pid: int) -> None:
    """Ask for a process that has just started; the threads that it starts later have the same."""
    with suppress(OSError):
        os.sched_setscheduler(pid, os.SCHED_RR, os.sched_param(_PRIORITY))


@contextmanager
def turns() -> Iterator[None]:
    """Ask for this thread, and whatever it starts, for a while."""
    before, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    ask_for_turns(0)
    try:
        yield
    finally:
        os.sched_setscheduler(0, before, parameters)
