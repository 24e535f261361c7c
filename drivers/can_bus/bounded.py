"""A call that may hang, with a limit on how long it is waited for."""

import threading
from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

T = TypeVar("T")


def bounded(call: Callable[[], T], timeout_s: float, undo: Callable[[T], object] = lambda _result: None) -> T:
    """Call in a thread of its own, and wait for it no longer than a time.

    Args:
        call: may hang; its exception is raised here.
        timeout_s: how long to wait [s].
        undo: is given a result that came too late.

    Raises:
        TimeoutError: it has not returned in time.
    """
    lock = threading.Lock()
    results: list[T] = []
    errors: list[BaseException] = []
    abandoned = threading.Event()

    def run() -> None:
        try:
            result = call()
        except BaseException as error:
            errors.append(error)
            return
        with lock:
            results.append(result)
            late = abandoned.is_set()
        if late:
            with suppress(Exception):
                undo(result)

    thread = threading.Thread(target=run, name="bounded call", daemon=True)
    thread.start()
    thread.join(timeout_s)
    with lock:
        if not results and not errors:
            abandoned.set()
            raise TimeoutError(f"not done within {timeout_s:g} s")
    if errors:
        raise errors[0]
    return results[0]
