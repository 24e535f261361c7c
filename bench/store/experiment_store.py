"""The experiments of a store."""

from collections.abc import Iterable
from contextlib import suppress

from sqlalchemy import select, update

from bench.json_types import Values
from bench.store.database import Database
from bench.store.errors import StoreError
from bench.store.records import HIDDEN, Experiment, NewExperiment
from bench.store.schema import EXPERIMENT
from bench.store.tables import chain, experiments
from bench.store.tables import tags as tags_of
from bench.store.upkeep.custody import UNWRITTEN, Custody
from bench.store.upkeep.importing import Import
from compensator.lab.recordings.recording import Recording


class ExperimentStore:
    """What was started or imported, and how it ended; `Store` is one."""

    custody: Custody
    _database: Database

    def begin_experiment(
        self,
        kind: str,
        parameters: Values,
        source: str,
        provenance: Values,
        rig: Values,
        operator: str = "",
        note: str = "",
    ) -> int:
        """Start an experiment from `source` "simulated", "real" or "imported". Returns its id.

        For `provenance` see `bench.provenance`; `rig` is the rig as in `rig.toml`.
        """
        new = NewExperiment(kind, parameters, provenance, rig, source, operator, note)
        self.custody.write_noted()
        self.custody.settle()
        with self._database.writing() as connection:
            return experiments.add(connection, self.custody.token(), new)

    def finish_experiment(
        self, experiment_id: int, outcome: str, reason: str = "", results: Values | None = None
    ) -> None:
        """Close an experiment; a trial of it that still runs is given the same outcome and reason.

        Raises:
            NotFoundError: no such experiment.
            StoreStateError: it is finished already.
        """
        try:
            with self._database.writing() as connection:
                experiments.finish(connection, experiment_id, outcome, reason, results or {})
        except UNWRITTEN:
            self.custody.note(experiment_id, outcome, reason)
            raise

    def experiment(self, experiment_id: int) -> Experiment:
        """One experiment, or `NotFoundError`."""
        with self._database.reading() as connection:
            return self.custody.as_ended(experiments.get(connection, experiment_id))

    def experiments(
        self,
        kind: str | None = None,
        outcome: str | None = None,
        source: str | None = None,
        tag: str | None = None,
        limit: int | None = None,
        offset: int = 0,
    ) -> list[Experiment]:
        """Experiments, newest first; all of them without a limit."""
        query = select(*experiments.COLUMNS).where(EXPERIMENT.c.outcome.not_in(HIDDEN))
        for name, value in {"kind": kind, "outcome": outcome, "source": source}.items():
            if value is not None:
                query = query.where(EXPERIMENT.c[name] == value)
        if tag is not None:
            query = query.where(tags_of.with_tag(tag))
        with self._database.reading() as connection:
            rows = connection.execute(query.order_by(EXPERIMENT.c.id.desc()).limit(limit).offset(offset)).all()
            known = tags_of.of_experiments(connection, [row.id for row in rows])
        return [self.custody.as_ended(Experiment(**row._asdict(), tags=known.get(row.id, ()))) for row in rows]

    def annotate(self, experiment_id: int, note: str | None = None, tags: Iterable[str] | None = None) -> None:
        """Change the note and the tags of an experiment, also of one that has ended; None leaves as it is.

        Raises:
            NotFoundError: no such experiment.
            StoreValueError: a tag that cannot be kept.
        """
        with self._database.writing() as connection:
            outcome = experiments.get(connection, experiment_id).outcome
            if note is not None:
                connection.execute(update(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id).values(note=note))
            if tags is not None:
                tags_of.write(connection, experiment_id, tags)
            if outcome != "running":
                chain.seal(connection, "experiment", [experiment_id])

    def add_imported(
        self,
        kind: str,
        parameters: Values,
        provenance: Values,
        rig: Values,
        recordings: Iterable[tuple[Recording, str, str]],
    ) -> int:
        """Add an experiment that was recorded elsewhere, with its trials: all, or nothing. Returns its id.

        Each recording comes with its trial's outcome and reason.
        """
        with self._database.writing():
            token = self.custody.token()
        found = Import(self._database, token, NewExperiment(kind, parameters, provenance, rig, "imported"))
        try:
            for recording, outcome, reason in recordings:
                found.add(recording, outcome, reason)
            return found.finish()
        except BaseException:
            with suppress(StoreError):  # a full or locked database: the next to open it removes what came in
                found.abandon()
            raise
