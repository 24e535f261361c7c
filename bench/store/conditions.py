"""Conditions of a trial as rows one can query: one column per type."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from sqlalchemy import ColumnElement, Connection, exists, insert, select

from bench.store.errors import StoreValueError
from bench.store.records import Condition
from bench.store.schema import TRIAL, TRIAL_CONDITION

Wanted = Condition | tuple[float, float]  # a value, or the lowest and highest number


def add(connection: Connection, trial_id: int, conditions: Mapping[str, Condition]) -> None:
    """Insert the conditions of a trial.

    Raises:
        StoreValueError: a value that is not finite, or neither number, text nor bool.
    """
    rows = [
        {"trial_id": trial_id, "key": key, "position": position, **_columns(key, value)}
        for position, (key, value) in enumerate(conditions.items())
    ]
    if rows:
        connection.execute(insert(TRIAL_CONDITION), rows)


def of_trials(connection: Connection, trial_ids: Iterable[int]) -> dict[int, dict[str, Condition]]:
    """The conditions of each trial, in the order in which they were given."""
    found: dict[int, dict[str, Condition]] = {trial_id: {} for trial_id in trial_ids}
    if not found:
        return found
    table = TRIAL_CONDITION.c
    query = select(TRIAL_CONDITION).order_by(table.trial_id, table.position)
    if len(found) < 500:  # databases bound the number of values in a statement
        query = query.where(table.trial_id.in_(found))
    else:
        query = query.where(table.trial_id.between(min(found), max(found)))
    for row in connection.execute(query):
        if row.trial_id in found:
            value = next(value for value in (row.number, row.text, row.flag) if value is not None)
            found[row.trial_id][row.key] = value
    return found


def match(key: str, wanted: Wanted) -> ColumnElement[bool]:
    """Trials whose condition `key` has this value, or lies between these two numbers (both included).

    Raises:
        StoreValueError: a value that no condition can have.
    """
    table = TRIAL_CONDITION.c
    if isinstance(wanted, tuple):
        lowest, highest = wanted
        hit: ColumnElement[bool] = table.number.between(lowest, highest)
    else:
        ((column, value),) = ((name, value) for name, value in _columns(key, wanted).items() if value is not None)
        hit = table[column] == value
    return exists().where(table.trial_id == TRIAL.c.id, table.key == key, hit)


def _columns(key: str, value: Any) -> dict[str, Condition | None]:
    columns: dict[str, Condition | None] = {"number": None, "text": None, "flag": None}
    if isinstance(value, bool):
        columns["flag"] = value
    elif isinstance(value, str):
        columns["text"] = value
    elif isinstance(value, (int, float)) and math.isfinite(value):
        columns["number"] = float(value)
    else:
        raise StoreValueError(
            f"condition '{key}' is {value!r}; wanted a finite number, text, true or false. Leave out what is not known"
        )
    return columns
