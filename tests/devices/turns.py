"""Turns of the processor for what runs against the wall clock: a simulated device, and the host that drives it.

On a machine that is busy with other work a thread may wait 50 ms for its turn, where a drive's own processor never
does. A real-time priority, where the system grants one (root, or `rtprio` in limits.conf), takes that away; where it
does not, everything runs as it is.

Several tests run beside each other. So a device goes before every host, as nothing keeps a real drive waiting; and
nothing that only starts (imports, mostly) has a priority, else it would keep the devices of other tests waiting.

`python -m tests.devices.turns` prints in how many processes the tests of drivers run: three where turns are granted, so
that nothing starves, else two.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress

HOST, DEVICE = 1, 2  # the lowest of the real-time priorities


def ask_for_turns(pid: int, priority: int) -> None:
    """Ask for all threads of a process; those that they start later have the same."""
    with suppress(OSError):
        for thread in os.listdir(f"/proc/{pid}/task"):
            os.sched_setscheduler(int(thread), os.SCHED_RR, os.sched_param(priority))


@contextmanager
def turns() -> Iterator[None]:
    """Ask for this thread, and whatever it starts, for a while."""
    with _scheduled(os.SCHED_RR, HOST):
        yield


@contextmanager
def no_turns() -> Iterator[None]:
    """What is started meanwhile takes its turns as every other program does."""
    with _scheduled(os.SCHED_OTHER, 0):
        yield


@contextmanager
def _scheduled(policy: int, priority: int) -> Iterator[None]:
    before, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    with suppress(OSError):
        os.sched_setscheduler(0, policy, os.sched_param(priority))
    try:
        yield
    finally:
        os.sched_setscheduler(0, before, parameters)


def are_granted() -> bool:
    """Whether the system grants turns."""
    with turns():
        return os.sched_getscheduler(0) == os.SCHED_RR


@contextmanager
def own_processors(pid: int) -> Iterator[None]:
    """Keep a device and this thread on processors of their own for a while, as a drive and its host are.

    Where the system puts both on one, each cycle waits for two changes of the program: which of two ways to drive it
    meets that is chance, and what is compared is no longer the ways. A machine with one processor is left as it is.
    """
    before = os.sched_getaffinity(0)
    if len(before) < 2:
        yield
        return
    device, host = sorted(before)[-1], before - {sorted(before)[-1]}
    for thread in os.listdir(f"/proc/{pid}/task"):
        with suppress(OSError):
            os.sched_setaffinity(int(thread), {device})
    os.sched_setaffinity(0, host)
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


if __name__ == "__main__":
    print(3 if are_granted() else 2)
