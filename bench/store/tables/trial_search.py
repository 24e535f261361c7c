"""Trials found by words and conditions, sorted, a page at a time: for a list that a person looks through."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime

from sqlalchemy import Column, ColumnElement, Connection, and_, func, not_, or_, select

from bench.store.errors import StoreValueError
from bench.store.records import HIDDEN
from bench.store.schema import EXPERIMENT, TRIAL, TRIAL_CONDITION
from bench.store.tables import conditions as condition_rows
from bench.store.tables.conditions import Wanted

SORTED_BY: dict[str, Column[object]] = {
    "trial": TRIAL.c.id, "name": TRIAL.c.name, "kind": TRIAL.c.kind, "outcome": TRIAL.c.outcome, "rows": TRIAL.c.rows,
}  # fmt: skip
MOST_WORDS = 8
LISTED = 100  # values that a statement names for each word; a database takes an expression of so many parts alone
ESCAPE = "\\"
ROUNDING = 5e-4  # relative: numbers are shown with four digits
SHOWN_AS = {"_kg": 1e-3, "_rad": math.radians(1.0), "_rad_s": math.radians(1.0)}  # SI of what the page shows as 1


@dataclass(frozen=True, slots=True)
class TrialQuery:
    """What is looked for.

    Attributes:
        experiment_id, kind, outcome: exact; None: any.
        words: each has to be in the name, kind, outcome, reason, a condition's name or text, or be the number of the
            trial or the value of a condition.
        begun: first moment, and the one after the last, in which the trial's experiment was begun; None: ever.
        conditions: value, or lowest and highest number, by condition.
        sort: a key of `SORTED_BY`; trials that are alike come in the order in which they were made.
        descending: the highest, or newest, first.
    """

    experiment_id: int | None = None
    kind: str | None = None
    outcome: str | None = None
    words: tuple[str, ...] = ()
    begun: tuple[datetime, datetime] | None = None
    conditions: Mapping[str, Wanted] = field(default_factory=dict)
    sort: str = "trial"
    descending: bool = False


def search(connection: Connection, wanted: TrialQuery, limit: int, offset: int) -> tuple[list[int], int]:
    """Ids of one page, and how many trials are found in all.

    Raises:
        StoreValueError: an unknown order, or too many words.
    """
    if wanted.sort not in SORTED_BY:
        raise StoreValueError(f"sort is '{wanted.sort}'; wanted is one of {', '.join(SORTED_BY)}")
    if len(wanted.words) > MOST_WORDS:
        raise StoreValueError(f"found {len(wanted.words)} words; wanted at most {MOST_WORDS}")
    where, words = filters(connection, wanted), _words(connection, wanted.words)
    key = SORTED_BY[wanted.sort]
    order = [column.desc() if wanted.descending else column.asc() for column in dict.fromkeys((key, TRIAL.c.id))]
    found = select(TRIAL.c.id).where(*where, *words).order_by(*order)
    if words:  # every trial is looked at once: counting them apart would look again
        ids = connection.execute(found).scalars().all()
        return list(ids[offset : offset + limit]), len(ids)
    count = connection.execute(select(func.count()).select_from(TRIAL).where(*where)).scalar_one()
    return list(connection.execute(found.limit(limit).offset(offset)).scalars()), int(count)


def filters(connection: Connection, wanted: TrialQuery) -> list[ColumnElement[bool]]:
    """All that is looked for, but for words.

    Raises:
        StoreValueError: a value that no condition can have.
    """
    found = condition_rows.match_all(wanted.conditions)
    hidden = list(connection.execute(select(EXPERIMENT.c.id).where(EXPERIMENT.c.outcome.in_(HIDDEN))).scalars())
    if hidden:
        found.append(not_(TRIAL.c.experiment_id.in_(hidden)))
    for column, value in (("experiment_id", wanted.experiment_id), ("kind", wanted.kind), ("outcome", wanted.outcome)):
        if value is not None:
            found.append(TRIAL.c[column] == value)
    if wanted.begun is not None:
        first, end = wanted.begun
        begun = select(EXPERIMENT.c.id).where(EXPERIMENT.c.started_utc >= first, EXPERIMENT.c.started_utc < end)
        found.append(TRIAL.c.experiment_id.in_(begun))
    return found


def _words(connection: Connection, words: Sequence[str]) -> list[ColumnElement[bool]]:
    if not words:
        return []
    columns: tuple[Column[str], ...] = (TRIAL.c.kind, TRIAL.c.outcome, TRIAL_CONDITION.c.key)
    few = {column: _values(connection, column) for column in columns}
    return [one for word in words if (one := _has(connection, word, few)) is not None]


def _has(connection: Connection, word: str, few: Mapping[Column[str], list[str] | None]) -> ColumnElement[bool] | None:
    """A word is somewhere in the trial; None where that is so of all of them.

    Conditions have few texts and keys: they are found first, trials by index. So do columns of few values, as `few`
    has them: their words are compared here, once each, and not with every trial. Where there are more than `LISTED` of
    them the database compares: a statement has room for so many values alone.
    """
    table = TRIAL_CONDITION.c

    def named(column: Column[str]) -> ColumnElement[bool]:
        values = few[column]
        if values is None:
            return _like(connection, column, word)
        return column.in_([one for one in values if word.lower() in one.lower()])

    hits = [_like(connection, TRIAL.c[name], word) for name in ("name", "reason")]
    hits += [named(TRIAL.c.kind), named(TRIAL.c.outcome)]
    told = _texts(connection, word)
    if any(_every_trial(connection, one) for one in told):
        return None
    # a flag that is not set is no sign of what it is called
    told.append(and_(named(table.key), or_(table.flag.is_(None), table.flag.is_(True))))
    number = _number(word)
    if number is not None:
        told += _numbers(number, few[table.key])
        hits.append(TRIAL.c.id == number)
    return or_(*hits, *(TRIAL.c.id.in_(select(table.trial_id).where(one)) for one in told))


def _texts(connection: Connection, word: str) -> list[ColumnElement[bool]]:
    """A condition's text has the word in it."""
    table, has = TRIAL_CONDITION.c, _like(connection, TRIAL_CONDITION.c.text, word)
    texts = select(table.key, table.text).where(table.text.is_not(None), has).distinct().limit(LISTED + 1)
    found = connection.execute(texts).all()
    if len(found) > LISTED:
        return [has]
    by_key: dict[str, list[str]] = {}
    for key, text in found:
        by_key.setdefault(key, []).append(text)
    return [and_(table.key == key, table.text.in_(of_key)) for key, of_key in by_key.items()]


def _numbers(number: float, keys: list[str] | None) -> list[ColumnElement[bool]]:
    """A condition is the number, as it is rounded where it is shown: in SI, or in grams and degrees."""
    table = TRIAL_CONDITION.c
    if keys is not None:
        return [and_(table.key == key, _about(number, _scale(key))) for key in keys]
    shown = [
        and_(table.key.like(f"%{_escaped(end)}", escape=ESCAPE), _about(number, scale))
        for end, scale in SHOWN_AS.items()
    ]
    return [or_(_about(number), *shown)]


def _every_trial(connection: Connection, condition: ColumnElement[bool]) -> bool:
    """Whether all trials meet a condition, of which none has two of one key: counted in the index alone."""
    met = select(func.count()).select_from(TRIAL_CONDITION).where(condition)
    return bool(connection.execute(select(met.scalar_subquery() == _COUNTED)).scalar_one())


_COUNTED = select(func.count()).select_from(TRIAL).scalar_subquery()


def _values(connection: Connection, column: Column[str]) -> list[str] | None:
    """The values of an indexed column: from one to the next in the index, as there are few of them and many rows.

    None where there are more than `LISTED`.
    """
    found: list[str] = []
    following = connection.execute(select(func.min(column))).scalar_one()
    while following is not None:
        if len(found) == LISTED:
            return None
        found.append(following)
        following = connection.execute(select(func.min(column)).where(column > following)).scalar_one()
    return found


def _like(connection: Connection, column: ColumnElement[str], word: str) -> ColumnElement[bool]:
    """A column has the word in it, in any case. SQLite's LIKE ignores the case by itself, three times as fast."""
    compare = column.like if connection.dialect.name == "sqlite" else column.ilike
    return compare(f"%{_escaped(word)}%", escape=ESCAPE)


def _escaped(word: str) -> str:
    return word.replace(ESCAPE, 2 * ESCAPE).replace("%", f"{ESCAPE}%").replace("_", f"{ESCAPE}_")


def _about(number: float, scale: float = 1.0) -> ColumnElement[bool]:
    spans = [sorted((value * (1 - ROUNDING), value * (1 + ROUNDING))) for value in {number, number * scale}]
    return or_(*(TRIAL_CONDITION.c.number.between(low, high) for low, high in spans))


def _scale(key: str) -> float:
    return next((scale for suffix, scale in SHOWN_AS.items() if key.endswith(suffix)), 1.0)


def _number(word: str) -> float | None:
    try:
        value = float(word)
    except ValueError:
        return None
    return value if abs(value) < 2**31 else None  # nan is below nothing
