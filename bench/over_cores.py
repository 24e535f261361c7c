"""The same work on many items, on all cores: whole benches, whose loops are Python and need a process each."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def over_cores(work: Callable[[Item], Result], items: Iterable[Item], workers: int | None = None) -> Iterator[Result]:
    """Do the work on every item; the results come in the order of the items.

    An item carries all that its result depends on, its seed too: then the results are the same bytes with any number
    of workers.

    Args:
        work: a function of a module, so that another process finds it by its name.
        items: picklable.
        workers: processes, each of which takes a second or two to start; one for each core where left out. 1 works in
            this process.

    Raises:
        Exception: what the work raised on an item, when its turn comes.
    """
    count = workers or os.cpu_count() or 1
    if count == 1:
        yield from map(work, items)
        return
    with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as pool:
        yield from pool.map(work, items)
