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
    columns = (table.trial_id, table.key, table.number, table.text, table.flag)
    query = select(*columns).order_by(table.trial_id, table.position)
    if len(found) < 500:  # databases bound the number of values in a statement
        query = query.where(table.trial_id.in_(found))
    else:
        query = query.where(table.trial_id.between(min(found), max(found)))
    for trial_id, key, number, text, flag in connection.execute(query):
        if trial_id in found:
            found[trial_id][key] = number if number is not None else text if text is not None else flag
    return found


def match_all(conditions: Mapping[str, Wanted]) -> list[ColumnElement[bool]]:
    """Trials whose conditions have these values, or lie between these two numbers (both included).

    Raises:
        StoreValueError: a value that no condition can have.
    """
    # a flag halves a list at best: another condition, if there is one, finds the trials by its index
    hits = [_hit(*item) for item in sorted(conditions.items(), key=lambda item: isinstance(item[1], bool))]
    table = TRIAL_CONDITION.c
    found: list[ColumnElement[bool]] = [TRIAL.c.id.in_(select(table.trial_id).where(*hit)) for hit in hits[:1]]
    return found + [exists().where(table.trial_id == TRIAL.c.id, *hit) for hit in hits[1:]]


def _hit(key: str, wanted: Wanted) -> tuple[ColumnElement[bool], ColumnElement[bool]]:
    table = TRIAL_CONDITION.c
    if isinstance(wanted, tuple):
        return table.key == key, table.number.between(*wanted)
    ((column, value),) = ((name, value) for name, value in _columns(key, wanted).items() if value is not None)
    return table.key == key, table[column] == value


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
