"""Pauses of a running program, as a busy or a virtual machine makes them: what hangs on none stays green."""

import random
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import psutil

EVERY_S = 0.1  # from the end of one pause to the next, in the mean


@contextmanager
def paused_at_times(process_id: int, pause_s: float, seed: int) -> Iterator[None]:
    """Stop one of the processes below a process at a time, and let it go on.

    Args:
        process_id: of the process; it is not stopped itself.
        pause_s: length of a pause [s]; without pauses where it is 0.
        seed: of the moments, and of which process it is.
    """
    over = threading.Event()
    thread = threading.Thread(target=_pause, args=(process_id, pause_s, random.Random(seed), over))
    if pause_s > 0.0:
        thread.start()
    try:
        yield
    finally:
        over.set()
        if thread.ident is not None:
            thread.join()


def _pause(process_id: int, pause_s: float, chance: random.Random, over: threading.Event) -> None:
    while not over.wait(chance.expovariate(1.0 / EVERY_S)):
        with suppress(psutil.NoSuchProcess):  # whoever was there may be gone
            below = psutil.Process(process_id).children(recursive=True)
            if not below:
                continue
            one = chance.choice(below)
            one.suspend()
            try:
                time.sleep(pause_s)
            finally:
                one.resume()
