"""Conditions that a column of a trial's own file holds: one value throughout, beside what a list of trials tells."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from bench.recording_set.conditions import FLAGS, condition_problem
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import ConditionColumn, Mapping
from bench.recording_set.text import values
from bench.recording_set.trials_csv import TRIALS_FILE, TrialEntry
from compensator.lab.recordings.recording import Condition, FloatArray

SAME = 1e-9  # relative: one value, written in two ways
SHOWN = 4  # values of a column that changes


def held(
    name: str,
    column: ConditionColumn,
    cells: FloatArray | Sequence[str],
    fault: Callable[[str, int, str], RecordingSetError],
) -> Condition | None:
    """The value of a condition that a column holds throughout a trial; None where every cell is empty.

    Args:
        name: of the condition.
        column: where it comes from.
        cells: of the column; text of conditions that are text, else numbers, NaN where a cell is empty.
        fault: makes an error of a message, a row (from 0) and a column.

    Raises:
        RecordingSetError: it changes within the trial, or is a value that the condition cannot have.
    """
    found: list[Condition | None]
    if isinstance(cells, np.ndarray):
        factor, offset = column.to_si()
        found = [None if math.isnan(one) else one for one in np.unique(cells * factor + offset).tolist()]
        alike = np.isclose(cells * factor + offset, next((one for one in found if one is not None), 0.0), rtol=SAME)
        others = np.flatnonzero(~alike & np.isfinite(cells))
    else:
        parsed = [values.parse(cell) for cell in cells]
        found = list(dict.fromkeys(parsed))
        first = next((one for one in found if one is not None), None)
        others = np.array([row for row, one in enumerate(parsed) if one is not None and one != first])
    known = [one for one in found if one is not None]
    if not known:
        return None
    if len(others):
        raise fault(_changes(name, column, known), int(others[0]), column.source)
    value = known[0]
    if problem := condition_problem(name, value):
        raise fault(f"as {name}: {problem}", 0, column.source)
    return bool(value) if name in FLAGS else value


def _changes(name: str, column: ConditionColumn, found: Sequence[Condition]) -> str:
    shown = ", ".join(_word(one) for one in found[:SHOWN])
    more = f" and {len(found) - SHOWN} more" if len(found) > SHOWN else ""
    return (
        f"{name} changes within the trial: found {shown}{more}; wanted one value throughout. Split the file where it "
        f"changes, each part a trial; or leave the column out: no [conditions.{name}] in the mapping, --take "
        f"'{column.source}=ignore'"
    )


def joined(entry: TrialEntry, found: dict[str, Condition], place: str, mapping: Mapping) -> dict[str, Condition]:
    """The conditions of a trial, of the list of trials and of the columns of its file.

    Raises:
        RecordingSetError: both tell a condition, and differ.
    """
    for name, value in found.items():
        told = entry.conditions.get(name, value)
        if not _is_same(told, value):
            where = "[[trials]] of the mapping" if entry.line is None else f"{TRIALS_FILE}, line {entry.line},"
            message = (
                f"{name} is {_word(value)} in the file, and {where} says {_word(told)}; wanted one of them. Correct "
                f"what is wrong, or leave one out: {name} there, or [conditions.{name}] of the mapping"
            )
            raise RecordingSetError(place, message, column=mapping.conditions[name].source)
    return found | entry.conditions


def _is_same(told: Condition, found: Condition) -> bool:
    if isinstance(told, str) or isinstance(found, str):
        return told == found
    return math.isclose(told, found, rel_tol=SAME)


def _word(value: Condition) -> str:
    return f"'{value}'" if isinstance(value, str) else f"{float(value):.6g}"
