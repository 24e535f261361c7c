"""Rows of the table of experiments. Each function works inside the caller's transaction."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, Row, Table, insert, select, update

from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.records import OUTCOMES, SOURCES, Experiment
from bench.store.schema import EXPERIMENT, TRIAL


def now() -> datetime:
    """The present time, UTC."""
    return datetime.now(UTC)


def insert_row(connection: Connection, table: Table, row: dict[str, Any]) -> int:
    """Insert one row. Returns the id that the database gave it."""
    row_id: int = connection.execute(insert(table).values(**row).returning(table.c.id)).scalar_one()
    return row_id


def add(connection: Connection, owner: str | None, **values: Any) -> int:
    """Insert an experiment that starts now. Returns its id.

    Raises:
        StoreValueError: a source that does not exist.
    """
    if values["source"] not in SOURCES:
        raise StoreValueError(f"source of an experiment is '{values['source']}'; wanted {', '.join(SOURCES)}")
    row = values | {"owner": owner, "started_utc": now(), "outcome": "running", "reason": "", "results": {}}
    return insert_row(connection, EXPERIMENT, row)


def finish(connection: Connection, experiment_id: int, outcome: str, reason: str, results: dict[str, Any]) -> None:
    """Close an experiment; a trial of it that still runs is given the same outcome.

    Raises:
        NotFoundError: no such experiment.
        StoreStateError: it is finished already.
        StoreValueError: an outcome that does not exist.
    """
    check_outcome(outcome)
    found = get(connection, experiment_id).outcome
    if found != "running":
        raise StoreStateError(f"experiment {experiment_id} is finished already ({found}); it cannot finish twice")
    end = {"finished_utc": now(), "outcome": outcome, "reason": reason}
    running = (TRIAL.c.experiment_id == experiment_id) & (TRIAL.c.outcome == "running")
    connection.execute(update(TRIAL).where(running).values(**end))
    connection.execute(update(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id).values(**end, results=results))


def running(connection: Connection) -> dict[int, str | None]:
    """The owner of each experiment that is marked running."""
    query = select(EXPERIMENT.c.id, EXPERIMENT.c.owner).where(EXPERIMENT.c.outcome == "running")
    return {row.id: row.owner for row in connection.execute(query)}


def get(connection: Connection, experiment_id: int) -> Experiment:
    """One experiment.

    Raises:
        NotFoundError: no such experiment.
    """
    row = connection.execute(select(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id)).one_or_none()
    if row is None:
        raise NotFoundError(f"experiment {experiment_id} is not in the store; list the experiments to see which are")
    return _record(row)


def find(
    connection: Connection,
    kind: str | None,
    outcome: str | None,
    source: str | None,
    limit: int | None,
    offset: int,
) -> list[Experiment]:
    """Experiments, newest first."""
    query = select(EXPERIMENT).order_by(EXPERIMENT.c.id.desc()).limit(limit).offset(offset)
    wanted = {"kind": kind, "outcome": outcome, "source": source}
    for name, value in wanted.items():
        if value is not None:
            query = query.where(EXPERIMENT.c[name] == value)
    return [_record(row) for row in connection.execute(query)]


def check_outcome(outcome: str) -> None:
    """Refuse an outcome that does not end anything.

    Raises:
        StoreValueError: not one of `OUTCOMES`, or "running".
    """
    if outcome == "running" or outcome not in OUTCOMES:
        wanted = ", ".join(name for name in OUTCOMES if name != "running")
        raise StoreValueError(f"outcome is '{outcome}'; wanted {wanted}")


def _record(row: Row[Any]) -> Experiment:
    values = row._asdict()
    del values["owner"]
    return Experiment(**values)
