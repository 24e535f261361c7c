"""How the threads of the service take turns: the event loop, which hears STOP, waits for few, and briefly for each.

Routes that look something up, fits and exports run in threads, and one thread of a process has the interpreter at a
time. Whenever the event loop wants it back, which is a few times for each request, it stands in line behind all others
that want it, and each of those may keep it for a switch interval. Both are kept small, so that the wait does not grow
with the number of clients: further requests wait for a thread, and STOP needs none.
"""

import sys

import anyio.to_thread

SWITCH_INTERVAL_S = 0.0005
"""How long a thread may keep the interpreter while others want it. Python's own is ten times that."""

MOST_HANDLERS = 4
"""Requests that are worked on in threads at a time; more of them are no faster, as they share the interpreter."""


def prepare() -> None:
    """Once, on the event loop, before the first request."""
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    anyio.to_thread.current_default_thread_limiter().total_tokens = MOST_HANDLERS
