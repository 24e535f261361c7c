"""Rows of the table of experiments. Each function works inside the caller's transaction."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, Row, Select, Table, insert, select, update

from bench.json_types import Values
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.records import HIDDEN, IMPORTING, OUTCOMES, SOURCES, Experiment, NewExperiment
from bench.store.schema import EXPERIMENT, HANDED_IN, TRIAL
from bench.store.tables import chain, tags

COLUMNS = tuple(EXPERIMENT.c[field.name] for field in fields(Experiment) if field.name != "tags")


def now() -> datetime:
    """The present time, UTC."""
    return datetime.now(UTC)


def insert_row(connection: Connection, table: Table, row: Mapping[str, object]) -> int:
    """Insert one row. Returns the id that the database gave it."""
    row_id: int = connection.execute(insert(table).values(**row).returning(table.c.id)).scalar_one()
    return row_id


def row_of(connection: Connection, query: Select[Any], one: str, listed: str) -> Row[Any]:
    """The only row that a query finds.

    Args:
        connection: inside a transaction.
        query: for it.
        one: what it is, with its number ("study 3"), for the message.
        listed: what may be listed to see which there are ("studies").

    Raises:
        NotFoundError: there is none.
    """
    row = connection.execute(query).one_or_none()
    if row is None:
        raise NotFoundError(f"{one} is not in the store; list the {listed} to see which are")
    return row


def add(connection: Connection, owner: str | None, new: NewExperiment, outcome: str = "running") -> int:
    """Insert an experiment that starts now. Returns its id.

    Raises:
        StoreValueError: a source that does not exist.
    """
    if new.source not in SOURCES:
        raise StoreValueError(f"source of an experiment is '{new.source}'; wanted {', '.join(SOURCES)}")
    begun: dict[str, object] = {"owner": owner, "started_utc": now(), "outcome": outcome, "reason": "", "results": {}}
    return insert_row(connection, EXPERIMENT, {**asdict(new), **begun, **facts_of(new.provenance)})


def finish(connection: Connection, experiment_id: int, outcome: str, reason: str, results: Values) -> None:
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
    ended = connection.execute(select(TRIAL.c.id).where(running)).scalars().all()
    connection.execute(update(TRIAL).where(running).values(**end))
    connection.execute(update(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id).values(**end, results=results))
    chain.seal(connection, "trial", ended)
    chain.seal(connection, "experiment", [experiment_id])


def show(connection: Connection, experiment_id: int, digests: Mapping[int, str]) -> None:
    """Let an import be seen that is complete.

    Args:
        connection: inside a transaction that writes, in which its trials were given their ends.
        experiment_id: the import.
        digests: of its trials.

    Raises:
        StoreStateError: another process took this one for dead, and removed what came in.
    """
    end = {"finished_utc": now(), "outcome": "completed", "owner": None}
    coming = (EXPERIMENT.c.id == experiment_id) & (EXPERIMENT.c.outcome == IMPORTING)
    if connection.execute(update(EXPERIMENT).where(coming).values(**end)).rowcount != 1:
        raise StoreStateError(f"the import {experiment_id} was removed by another process meanwhile; import it again")
    chain.enter(connection, "trial", digests)
    chain.seal(connection, "experiment", [experiment_id])


def unfinished(connection: Connection) -> list[tuple[int, str | None, str]]:
    """id, owner and outcome of each experiment that is marked running, or that nobody sees.

    Without what a bench is handing in: it goes on where it was broken off.
    """
    columns = EXPERIMENT.c
    coming = select(HANDED_IN.c.experiment_id).where(HANDED_IN.c.complete.is_(False))
    query = select(columns.id, columns.owner, columns.outcome).where(
        columns.outcome.in_(("running", *HIDDEN)), columns.id.not_in(coming)
    )
    return [(row.id, row.owner, row.outcome) for row in connection.execute(query)]


def get(connection: Connection, experiment_id: int) -> Experiment:
    """One experiment.

    Raises:
        NotFoundError: no such experiment.
    """
    query = select(*COLUMNS).where(EXPERIMENT.c.id == experiment_id, EXPERIMENT.c.outcome.not_in(HIDDEN))
    row = row_of(connection, query, f"experiment {experiment_id}", "experiments")
    return Experiment(**row._asdict(), tags=tags.of_experiments(connection, [experiment_id]).get(experiment_id, ()))


def check_outcome(outcome: str) -> None:
    """Refuse an outcome that does not end anything.

    Raises:
        StoreValueError: not one of `OUTCOMES`, or "running".
    """
    if outcome == "running" or outcome not in OUTCOMES:
        wanted = ", ".join(name for name in OUTCOMES if name != "running")
        raise StoreValueError(f"outcome is '{outcome}'; wanted {wanted}")


PATHS = {
    "bench": ("configuration", "name"),
    "software_version": ("software", "version"),
    "software_commit": ("software", "commit"),
    "drive": ("drive", "product"),
    "firmware": ("drive", "firmware"),
}
LARGEST_SEED = 2**63 - 1


def facts_of(provenance: Mapping[str, Any]) -> dict[str, str | int | None]:
    """Column -> value; None where the provenance does not say."""
    seed = provenance.get("seed")
    fits = isinstance(seed, int) and not isinstance(seed, bool) and abs(seed) <= LARGEST_SEED
    return {**{name: _text(provenance, path) for name, path in PATHS.items()}, "seed": seed if fits else None}


def _text(provenance: Mapping[str, Any], path: tuple[str, str]) -> str | None:
    section = provenance.get(path[0])
    value = section.get(path[1]) if isinstance(section, Mapping) else None
    return None if value is None else str(value)
