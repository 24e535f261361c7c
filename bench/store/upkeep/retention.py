"""Removing experiments that are older than the policy keeps them. What a study or a calibration uses stays."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import Connection, select

from bench.store.database import Database
from bench.store.records import HIDDEN
from bench.store.schema import CALIBRATION, EXPERIMENT, STUDY, TRIAL
from bench.store.tables.blocks import SAMPLE_BYTES
from bench.store.tables.experiments import now
from bench.store.upkeep.removal import remove


@dataclass(frozen=True, slots=True)
class Policy:
    """How long experiments are kept after their end [days]; None: for ever. Where several apply, the shortest.

    Attributes:
        completed_days: those that completed, imports too.
        incomplete_days: those that were stopped, tripped, failed, interrupted or refused.
        simulated_days: those of a simulated drive, however they ended.
        audit_days: entries of the audit log.
    """

    completed_days: float | None = None
    incomplete_days: float | None = None
    simulated_days: float | None = None
    audit_days: float | None = None

    def keeps_days(self, outcome: str, source: str) -> float | None:
        """How long an experiment is kept [days]."""
        limits = [self.completed_days if outcome == "completed" else self.incomplete_days]
        limits.append(self.simulated_days if source == "simulated" else None)
        return min((limit for limit in limits if limit is not None), default=None)


@dataclass(frozen=True, slots=True)
class Expired:
    """An experiment that the policy does not keep.

    Attributes:
        size_bytes: of its samples.
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

    def expired(self, policy: Policy, at_utc: datetime | None = None) -> list[Expired]:
        """What the policy does not keep, oldest first. Nothing is removed."""
        moment = at_utc or now()
        with self._database.reading() as connection:
            used = _uses(connection)
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


def _uses(connection: Connection) -> dict[int, list[str]]:
    """Experiment -> who uses it."""
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
