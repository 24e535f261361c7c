"""Judges items on all cores, keeps every result as it comes, and goes on where an earlier run was ended."""

import json
import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from bench.blind.items import Item
from bench.blind.judge import Result, judge
from bench.errors import BenchError

Shown = Callable[[int, int], None]
"""Called with (items done, items in all) as results come."""


class ResultsError(BenchError, OSError):
    """Raised when a file of results cannot be read or written, or holds something else."""


def run_items(items: Sequence[Item], kept: Path | None, shown: Shown, workers: int | None = None) -> list[Result]:
    """Judge items, in the order given whatever order they end in.

    Args:
        items: to be judged.
        kept: file of results, one JSON object a line; what it holds is not done again. None: nothing is kept.
        shown: told of the progress.
        workers: processes; 0 judges in this one; None takes all cores.

    Raises:
        ResultsError: the file cannot be used.
    """
    done = {} if kept is None else _read(kept)
    open_items = [item for item in items if item.key not in done]
    shown(len(items) - len(open_items), len(items))
    for result in _judged(open_items, os.cpu_count() if workers is None else workers):
        done[result.key] = result
        if kept is not None:
            _append(kept, result)
        shown(sum(item.key in done for item in items), len(items))
    return [done[item.key] for item in items]


def _judged(items: Sequence[Item], workers: int | None) -> Iterator[Result]:
    if not workers or len(items) < 2:
        yield from map(judge, items)
        return
    # started afresh, not forked: threads and compiled code do not survive a fork
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(workers, len(items)), mp_context=context) as executor:
        try:
            for future in as_completed([executor.submit(judge, item) for item in items]):
                yield future.result()
        finally:
            executor.shutdown(wait=False, cancel_futures=True)


def _read(path: Path) -> dict[str, Result]:
    if not path.exists():
        return {}
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
        results = [Result.from_json(json.loads(line)) for line in lines if line]
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise ResultsError(f"{path}: holds something else than results of this version; name another file") from error
    return {result.key: result for result in results}


def _append(path: Path, result: Result) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(result.to_json()) + "\n")
    except OSError as error:
        raise ResultsError(f"{path}: cannot be written: {error.strerror}") from error
