"""Judges items on all cores or a cluster, keeps every result as it comes, and goes on where a run was ended."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from bench.errors import BenchError
from bench.evaluation.blind.items import Item
from bench.evaluation.blind.judge import judge
from bench.evaluation.blind.result import Result
from bench.parallel.over_cores import as_they_end

Shown = Callable[[int, int], None]
"""Called with (items done, items in all) as results come."""


class ResultsError(BenchError, OSError):
    """Raised when a file of results cannot be read or written, or holds something else."""


def run_items(
    items: Sequence[Item],
    kept: Path | None,
    shown: Shown,
    workers: int | None = None,
    cluster: str | None = None,
    ask: Callable[[Item], Result] = judge,
) -> list[Result]:
    """Judge items, in the order given whatever order they end in.

    Args:
        items: to be judged.
        kept: file of results, one JSON object a line; what it holds is not done again. None: nothing is kept.
        shown: told of the progress.
        workers: processes; 0 or 1 judges in this one; None takes all cores.
        cluster: address of a Dask scheduler, whose workers judge instead.
        ask: draws and judges one item; a function of a module.

    Raises:
        ClusterError: the cluster cannot be used.
        ResultsError: the file cannot be used.
    """
    done = {} if kept is None else _read(kept)
    open_items = [item for item in items if item.key not in done]
    shown(len(items) - len(open_items), len(items))
    for result in as_they_end(ask, open_items, 1 if len(open_items) < 2 else workers, cluster):
        done[result.key] = result
        if kept is not None:
            _append(kept, result)
        shown(sum(item.key in done for item in items), len(items))
    return [done[item.key] for item in items]


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
