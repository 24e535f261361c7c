"""Rows of the tables of trials and events. Each function works inside the caller's transaction."""

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, Row, insert, select, update
from sqlalchemy.exc import IntegrityError

from bench.config.channels import KEPT
from bench.json_types import Values
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.records import HIDDEN, Condition, Event, Trial
from bench.store.schema import EVENT, EXPERIMENT, TRIAL
from bench.store.tables import chain
from bench.store.tables import conditions as condition_rows
from bench.store.tables.experiments import check_outcome, insert_row, now, row_of


def add(
    connection: Connection,
    experiment_id: int,
    name: str,
    kind: str,
    conditions: Mapping[str, Condition],
    channels: Sequence[str],
    outcome: str = "running",
) -> int:
    """Insert a trial that starts now. Returns its id.

    Raises:
        StoreStateError: there is no such experiment, or it is finished.
        StoreValueError: a second trial of that name, a channel or condition that cannot be kept.
    """
    _check_experiment(connection, experiment_id, outcome)
    _check_channels(name, channels)
    values = {
        "experiment_id": experiment_id,
        "name": name,
        "kind": kind,
        "channels": list(channels),
        "rows": 0,
        "started_utc": now(),
        "outcome": outcome,
        "reason": "",
        "results": {},
    }
    try:
        trial_id = insert_row(connection, TRIAL, values)
    except IntegrityError as error:
        raise StoreValueError(
            f"experiment {experiment_id} has a trial '{name}' already; give each trial a name of its own"
        ) from error
    condition_rows.add(connection, trial_id, conditions)
    return trial_id


def finish(connection: Connection, trial_id: int, outcome: str, reason: str, results: Values) -> None:
    """Close a trial.

    Raises:
        StoreStateError: it is finished already.
        StoreValueError: an outcome that does not exist.
    """
    check_outcome(outcome)
    end = {"finished_utc": now(), "outcome": outcome, "reason": reason, "results": results}
    running = (TRIAL.c.id == trial_id) & (TRIAL.c.outcome == "running")
    if connection.execute(update(TRIAL).where(running).values(**end)).rowcount != 1:
        raise StoreStateError(f"trial {trial_id} is finished already; it cannot finish twice")
    chain.seal(connection, "trial", [trial_id])


def add_events(connection: Connection, trial_id: int, events: Sequence[Event]) -> None:
    """Insert events of a trial."""
    if events:
        # inline: nobody asks for their numbers
        connection.execute(insert(EVENT).inline(), [{"trial_id": trial_id, **event._asdict()} for event in events])


def events(connection: Connection, trial_id: int) -> list[Event]:
    """The events of a trial, in order of time."""
    query = select(EVENT.c.time_s, EVENT.c.name, EVENT.c.detail).where(EVENT.c.trial_id == trial_id)
    return [Event(*row) for row in connection.execute(query.order_by(EVENT.c.time_s, EVENT.c.id))]


def get(connection: Connection, trial_id: int) -> Trial:
    """One trial.

    Raises:
        NotFoundError: no such trial.
    """
    query = select(TRIAL).where(TRIAL.c.id == trial_id, TRIAL.c.outcome.not_in(HIDDEN))
    row = row_of(connection, query, f"trial {trial_id}", "trials")
    return record(row, condition_rows.of_trials(connection, [row.id]))


def of_ids(connection: Connection, ids: Sequence[int]) -> list[Trial]:
    """Trials in the order of their ids in a list; those that were removed meanwhile are left out."""
    query = select(TRIAL).where(TRIAL.c.id.in_(ids), TRIAL.c.outcome.not_in(HIDDEN))
    rows = {row.id: row for row in connection.execute(query)}
    found = condition_rows.of_trials(connection, rows)
    return [record(rows[trial_id], found) for trial_id in ids if trial_id in rows]


def _check_experiment(connection: Connection, experiment_id: int, wanted: str) -> None:
    query = select(EXPERIMENT.c.outcome).where(EXPERIMENT.c.id == experiment_id)
    outcome = connection.execute(query).scalar_one_or_none()
    if outcome is None:
        raise NotFoundError(f"experiment {experiment_id} is not in the store; begin one before its trials")
    if outcome != wanted:
        raise StoreStateError(f"experiment {experiment_id} is finished ({outcome}); begin a new one for more trials")


def _check_channels(name: str, channels: Sequence[str]) -> None:
    unknown = [channel for channel in channels if channel not in KEPT]
    if unknown or len(set(channels)) != len(channels) or "time_s" not in channels:
        raise StoreValueError(
            f"trial '{name}' has the channels {', '.join(channels) or 'none'}; wanted time_s and any of "
            f"{', '.join(KEPT)}, each once"
        )


def record(row: Row[Any], conditions: Mapping[int, dict[str, Condition]]) -> Trial:
    """A row, with the conditions of trials by their ids."""
    values = row._asdict() | {"channels": tuple(row.channels), "conditions": conditions[row.id]}
    return Trial(**values)
