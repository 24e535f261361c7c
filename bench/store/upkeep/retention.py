"""Removing experiments that are older than the policy keeps them. What a study or a calibration uses stays."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import Connection, delete, select, update

from bench.config.sections import RetentionSettings
from bench.store.database import Database
from bench.store.records import HIDDEN, REMOVING
from bench.store.schema import CALIBRATION, EXPERIMENT, SAMPLE_BLOCK, STUDY, TRIAL
from bench.store.tables import chain
from bench.store.tables.experiments import now
from bench.store.tables.samples import SAMPLE_BYTES


@dataclass(frozen=True, slots=True)
class Expired:
    """An experiment that the policy does not keep.

    Attributes:
        used_by: the studies and calibrations that use it, in words; empty where nobody does.
    """

    experiment_id: int
    kind: str
    source: str
    outcome: str
    finished_utc: datetime
    trials: int
    size_bytes: int
    used_by: tuple[str, ...]


class Retention:
    """`Store.retention`."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def expired(self, policy: RetentionSettings) -> list[Expired]:
        """What the policy does not keep, oldest first. Nothing is removed."""
        moment = now()
        with self._database.reading() as connection:
            used = uses(connection)
            query = select(EXPERIMENT).where(
                EXPERIMENT.c.finished_utc.is_not(None), EXPERIMENT.c.outcome.not_in(("running", *HIDDEN))
            )
            found = []
            for row in connection.execute(query.order_by(EXPERIMENT.c.id)).all():
                days = policy.keeps_days(row.outcome, row.source)
                if days is None or moment - row.finished_utc <= timedelta(days=days):
                    continue
                users = tuple(used.get(row.id, ()))
                what = (row.id, row.kind, row.source, row.outcome, row.finished_utc)
                found.append(Expired(*what, *_size(connection, row.id), users))
        return found

    def remove(self, experiment_ids: Collection[int]) -> None:
        """Remove experiments with all that belongs to them; whoever reads them meanwhile is told that they are gone."""
        for experiment_id in experiment_ids:
            remove(self._database, experiment_id)


def uses(connection: Connection) -> dict[int, list[str]]:
    """Experiment -> who uses it, in words: the studies and calibrations of the store."""
    of_trial = {row.id: row.experiment_id for row in connection.execute(select(TRIAL.c.id, TRIAL.c.experiment_id))}
    users: dict[int, list[str]] = {}

    def note(name: str, trials: Sequence[int], experiments: Sequence[int] = ()) -> None:
        for experiment_id in {*experiments, *(of_trial[trial] for trial in trials if trial in of_trial)}:
            users.setdefault(experiment_id, []).append(name)

    for row in connection.execute(select(STUDY).order_by(STUDY.c.id)):
        note(f"study {row.id} ({row.name})", row.definition.get("trial_ids", ()))
    for row in connection.execute(select(CALIBRATION).order_by(CALIBRATION.c.id)):
        note(f"calibration {row.id}", row.trial_ids, row.experiment_ids)
    return users


def _size(connection: Connection, experiment_id: int) -> tuple[int, int]:
    """Trials of an experiment, and the bytes of their samples."""
    query = select(TRIAL.c.rows, TRIAL.c.channels).where(TRIAL.c.experiment_id == experiment_id)
    sizes = [rows * len(channels) * SAMPLE_BYTES for rows, channels in connection.execute(query)]
    return len(sizes), sum(sizes)


BLOCKS_AT_ONCE = 64


def mark(connection: Connection, experiment_id: int) -> None:
    """From now on nobody sees it. Where the process ends meanwhile, the next to open the store goes on."""
    trials = select(TRIAL.c.id).where(TRIAL.c.experiment_id == experiment_id, TRIAL.c.outcome.not_in(HIDDEN))
    chain.seal_removal(connection, "trial", connection.execute(trials.order_by(TRIAL.c.id)).scalars().all())
    seen = select(EXPERIMENT.c.id).where(EXPERIMENT.c.id == experiment_id, EXPERIMENT.c.outcome.not_in(HIDDEN))
    chain.seal_removal(connection, "experiment", connection.execute(seen).scalars().all())
    ends = update(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id).values(outcome=REMOVING, owner=None)
    connection.execute(ends)
    connection.execute(update(TRIAL).where(TRIAL.c.experiment_id == experiment_id).values(outcome=REMOVING))


def remove(database: Database, experiment_id: int) -> None:
    """Remove an experiment, its trials and their samples. Nothing happens where it is gone."""
    with database.writing() as connection:
        mark(connection, experiment_id)
    with database.reading() as connection:
        trials = connection.execute(select(TRIAL.c.id).where(TRIAL.c.experiment_id == experiment_id)).scalars().all()
    for trial_id in trials:
        while _remove_blocks(database, trial_id):
            pass
        with database.writing() as connection:
            connection.execute(delete(TRIAL).where(TRIAL.c.id == trial_id))  # conditions, events, overview with it
    with database.writing() as connection:
        connection.execute(delete(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id))


def _remove_blocks(database: Database, trial_id: int) -> int:
    table = SAMPLE_BLOCK.c
    with database.writing() as connection:
        query = select(table.first_row).where(table.trial_id == trial_id).order_by(table.first_row)
        rows = connection.execute(query.limit(BLOCKS_AT_ONCE)).scalars().all()
        if rows:
            connection.execute(delete(SAMPLE_BLOCK).where(table.trial_id == trial_id, table.first_row <= rows[-1]))
    return len(rows)
