"""Removing one experiment or one study, because somebody wants it gone: by number, and only where nobody needs it."""

from sqlalchemy import Connection, delete, func, select

from bench.store.database import Database
from bench.store.errors import StoreStateError
from bench.store.records import HIDDEN
from bench.store.schema import CALIBRATION, EXPERIMENT, MODEL, STUDY, TRIAL
from bench.store.tables import chain
from bench.store.tables.experiments import row_of
from bench.store.upkeep.retention import mark, remove, uses


class Removal:
    """`Store.removal`."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def experiment(self, experiment_id: int) -> str:
        """Remove an experiment with its trials, samples and events; whoever reads it meanwhile is told that it is gone.

        Its parameters are not looked at: what cannot be read any more can be removed.

        Returns:
            What is gone, in words.

        Raises:
            NotFoundError: no such experiment.
            StoreStateError: it runs, or a study or a calibration uses it.
        """
        with self._database.writing() as connection:
            what = _unused_experiment(connection, experiment_id)
            mark(connection, experiment_id)
        remove(self._database, experiment_id)
        return what

    def study(self, study_id: int) -> str:
        """Remove a study with its models; its trials stay.

        Returns:
            What is gone, in words.

        Raises:
            NotFoundError: no such study.
            StoreStateError: a calibration carries a model of it.
        """
        with self._database.writing() as connection:
            what = _unused_study(connection, study_id)
            models = connection.execute(select(MODEL.c.id).where(MODEL.c.study_id == study_id).order_by(MODEL.c.id))
            chain.seal_removal(connection, "model", models.scalars().all())
            chain.seal_removal(connection, "study", [study_id])
            connection.execute(delete(STUDY).where(STUDY.c.id == study_id))  # models with it
        return what


def _unused_experiment(connection: Connection, experiment_id: int) -> str:
    own = EXPERIMENT.c
    query = select(own.kind, own.outcome).where(own.id == experiment_id, own.outcome.not_in(HIDDEN))
    found = row_of(connection, query, f"experiment {experiment_id}", "experiments")
    if found.outcome == "running":
        raise StoreStateError(f"experiment {experiment_id} is running; stop it, or wait for its end, then remove it")
    users = uses(connection).get(experiment_id, ())
    if users:
        raise StoreStateError(
            f"experiment {experiment_id} cannot be removed: {', '.join(users)} could not be followed back to its data "
            "any more. Remove a study first; what a calibration rests on stays"
        )
    counted = select(func.count(), func.coalesce(func.sum(TRIAL.c.rows), 0)).where(
        TRIAL.c.experiment_id == experiment_id
    )
    trials, rows = connection.execute(counted).one()
    return f"experiment {experiment_id} ({found.kind}, {found.outcome}, {trials} trials, {int(rows)} rows)"


def _unused_study(connection: Connection, study_id: int) -> str:
    query = select(STUDY.c.name).where(STUDY.c.id == study_id)
    name = row_of(connection, query, f"study {study_id}", "studies").name
    calibrations = connection.execute(select(CALIBRATION.c.id, CALIBRATION.c.result).order_by(CALIBRATION.c.id))
    users = [str(row.id) for row in calibrations if (row.result.get("study") or {}).get("study_id") == study_id]
    if users:
        raise StoreStateError(
            f"study {study_id} cannot be removed: calibration {', '.join(users)} carries a model of it, and could not "
            "be followed back to its data any more"
        )
    models = connection.execute(select(func.count()).where(MODEL.c.study_id == study_id)).scalar_one()
    return f"study {study_id} ({name}, {models} models)"
