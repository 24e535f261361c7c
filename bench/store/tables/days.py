"""On which days something was recorded, and how much: for a strip of sessions."""

from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta, timezone

from sqlalchemy import Connection, case, func, not_, select

from bench.store.errors import StoreValueError
from bench.store.records import HIDDEN
from bench.store.schema import EXPERIMENT, TRIAL


@dataclass(frozen=True, slots=True)
class Day:
    """What was begun on one day.

    Attributes:
        experiments, trials: how many; a trial belongs to the day on which its experiment was begun.
        not_completed: trials that ended otherwise, or still run.
    """

    day: date
    experiments: int
    trials: int
    not_completed: int


def days(connection: Connection, offset_min: int, limit: int) -> list[Day]:
    """The newest days on which something was begun, newest first.

    Args:
        connection: to the store.
        offset_min: of the local time that days are counted in, ahead of UTC [min].
        limit: days at most.
    """
    failed = func.coalesce(func.sum(case((TRIAL.c.outcome != "completed", 1), else_=0)), 0)
    query = (
        select(EXPERIMENT.c.started_utc, func.count(TRIAL.c.id), failed)
        .outerjoin(TRIAL, TRIAL.c.experiment_id == EXPERIMENT.c.id)
        .where(not_(EXPERIMENT.c.outcome.in_(HIDDEN)))
        .group_by(EXPERIMENT.c.id, EXPERIMENT.c.started_utc)
    )
    zone = timezone(timedelta(minutes=offset_min))
    found: dict[date, Day] = {}
    for started_utc, trials, not_completed in connection.execute(query):
        day = started_utc.astimezone(zone).date()
        before = found.get(day, Day(day, 0, 0, 0))
        found[day] = Day(
            day, before.experiments + 1, before.trials + int(trials), before.not_completed + int(not_completed)
        )
    return sorted(found.values(), key=lambda one: one.day, reverse=True)[:limit]


def begin_and_end(day: date, offset_min: int) -> tuple[datetime, datetime]:
    """First moment of a local day, and of the day after, in UTC.

    Raises:
        StoreValueError: no year of ours.
    """
    if not 1900 <= day.year <= 2999:
        raise StoreValueError(f"day is {day}; wanted is one of the years 1900 to 2999")
    begin = datetime.combine(day, time(), timezone(timedelta(minutes=offset_min))).astimezone(UTC)
    return begin, begin + timedelta(days=1)
