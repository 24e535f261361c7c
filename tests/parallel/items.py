"""Small items of work for other processes, which import no more for them than this file."""

import os
import time
from pathlib import Path


def squared(number: int) -> tuple[int, int]:
    """Its square, and the process that computed it."""
    if number < 0:
        raise ValueError(f"{number} is below 0")
    return number**2, os.getpid()


def takes_its_worker_with_it_once(mark: Path) -> int:
    """The length of a file's name; the process ends where the file is not there yet."""
    if not mark.exists():
        mark.touch()
        os._exit(1)
    return len(mark.name)


def after(seconds: float) -> float:
    """The same, some seconds later."""
    time.sleep(seconds)
    return seconds
