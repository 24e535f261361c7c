"""The store: everything that was measured, and every model made from it."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from types import TracebackType
from typing import Any, Self

from bench.store import experiments, samples, trials
from bench.store.access_records import AccessRecords
from bench.store.calibrations import Calibrations
from bench.store.conditions import Wanted
from bench.store.custody import UNWRITTEN, Custody
from bench.store.database import Database
from bench.store.errors import StoreError, StoreValueError
from bench.store.importing import Import
from bench.store.migration import migrate
from bench.store.queue import QueueTable
from bench.store.records import Condition, Event, Experiment, Trial
from bench.store.reduction import MIN_POINTS
from bench.store.retention import Retention
from bench.store.space import SpaceNeed
from bench.store.study_store import StudyStore
from bench.store.trial_writer import TrialWriter
from bench.store.upkeep import Upkeep
from bench.store.window import Stretch, reduced
from compensator.lab.recording import FloatArray, Recording

BUSY_TIMEOUT_S = 10.0


class Store(StudyStore):
    """Experiments, trials, samples, events, studies, models. Every method may be called from any thread.

    One writer at a time, in all processes together; readers never wait and see whole transactions.
    Use `open`, then `close`, or a `with` block.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self.calibrations = Calibrations(database)
        self.access = AccessRecords(database)
        self.custody = Custody(database)

    @classmethod
    def open(cls, url: str, busy_timeout_s: float = BUSY_TIMEOUT_S) -> Self:
        """Open a database; create or upgrade its tables; mark as interrupted what a dead process left running.

        Args:
            url: "sqlite:///bench.sqlite", or "postgresql://user@host/database".
            busy_timeout_s: how long a write waits for another one before `StoreLockedError` [s].

        Raises:
            StoreFileError: no such folder, no database, a database of another program, or a damaged one.
            StoreVersionError: made by a newer version.
            StoreLockedError, StoreFullError, StoreReadOnlyError, StoreUnreachableError
        """
        store = cls(Database(url, busy_timeout_s))
        try:
            migrate(store._database)
            store.custody.settle()
        except BaseException:
            store.close()
            raise
        return store

    def close(self) -> None:
        """Close the database. What this store left running is marked interrupted. Safe to call twice."""
        self.custody.close()
        self._database.close()

    def require_space(self, need: SpaceNeed, trials: int) -> None:
        """Refuse to begin what the disk has no room for.

        Raises:
            StoreFullError: with how much is free, how much is needed, and what to do.
        """
        need.check(self._database.backend.free_bytes(), trials, self._database.where)

    @property
    def upkeep(self) -> Upkeep:
        """Information, check, backup, vacuum."""
        return Upkeep(self._database)

    @property
    def retention(self) -> Retention:
        """Removing what nobody needs any more."""
        return Retention(self._database)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    # experiments

    def begin_experiment(
        self,
        kind: str,
        parameters: dict[str, Any],
        source: str,
        provenance: dict[str, Any],
        rig: dict[str, Any],
        operator: str = "",
        note: str = "",
    ) -> int:
        """Start an experiment from `source` "simulated", "real" or "imported". Returns its id.

        For `provenance` see `bench.provenance`; `rig` is the rig as in `rig.toml`.
        """
        values = {
            "kind": kind,
            "parameters": parameters,
            "source": source,
            "provenance": provenance,
            "rig": rig,
            "operator": operator,
            "note": note,
        }
        self.custody.write_noted()
        self.custody.settle()
        with self._database.writing() as connection:
            return experiments.add(connection, self.custody.token(), values)

    def finish_experiment(
        self, experiment_id: int, outcome: str, reason: str = "", results: dict[str, Any] | None = None
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
        with self._database.reading() as connection:
            found = experiments.find(connection, kind, outcome, source, tag, limit, offset)
        return list(map(self.custody.as_ended, found))

    def annotate(self, experiment_id: int, note: str | None = None, tags: Iterable[str] | None = None) -> None:
        """Change the note and the tags of an experiment, also of one that has ended; None leaves as it is.

        Raises:
            NotFoundError: no such experiment.
            StoreValueError: a tag that cannot be kept.
        """
        with self._database.writing() as connection:
            experiments.annotate(connection, experiment_id, note, tags)

    def queue(self, bench: str) -> QueueTable:
        """The queue of a bench."""
        return QueueTable(self._database, bench)

    def add_imported(
        self,
        kind: str,
        parameters: dict[str, Any],
        provenance: dict[str, Any],
        rig: dict[str, Any],
        recordings: Iterable[tuple[Recording, str, str]],
    ) -> int:
        """Add an experiment that was recorded elsewhere, with its trials: all, or nothing. Returns its id.

        Each recording comes with its trial's outcome and reason.
        """
        values = {"kind": kind, "parameters": parameters, "provenance": provenance, "rig": rig}
        with self._database.writing():
            token = self.custody.token()
        found = Import(self._database, token, values)
        try:
            for recording, outcome, reason in recordings:
                found.add(recording, outcome, reason)
            return found.finish()
        except BaseException:
            with suppress(StoreError):  # a full or locked database: the next to open it removes what came in
                found.abandon()
            raise

    # trials

    def begin_trial(
        self,
        experiment_id: int,
        name: str,
        kind: str,
        conditions: Mapping[str, Condition],
        channels: Sequence[str],
    ) -> TrialWriter:
        """Start a trial of a running experiment.

        Args:
            experiment_id: the experiment that it is part of.
            name: unique within the experiment.
            kind: what is done ("steps", "load-sweep").
            conditions: what is held constant; finite numbers, text, bools.
            channels: names from `compensator.lab.channels`, in the order of the columns of the rows.

        Raises:
            NotFoundError: no such experiment.
            StoreStateError: the experiment is finished.
            StoreValueError: the name is taken, or a condition or channel cannot be kept.
        """
        with self._database.writing() as connection:
            trial_id = trials.add(connection, experiment_id, name, kind, conditions, channels)
        return TrialWriter(self._database, trial_id, tuple(channels))

    def trial(self, trial_id: int) -> Trial:
        """One trial, or `NotFoundError`."""
        with self._database.reading() as connection:
            return self.custody.as_ended(trials.get(connection, trial_id))

    def trials(
        self,
        experiment_id: int | None = None,
        kind: str | None = None,
        outcome: str | None = None,
        source: str | None = None,
        conditions: Mapping[str, Wanted] | None = None,
        limit: int | None = None,
        offset: int = 0,
    ) -> list[Trial]:
        """Trials in the order in which they were made; all of them without a limit.

        `conditions` maps a condition to the wanted value, or to the (lowest, highest) wanted number.
        """
        with self._database.reading() as connection:
            wanted = conditions or {}
            found = trials.find(connection, experiment_id, kind, outcome, source, wanted, limit, offset)
        return list(map(self.custody.as_ended, found))

    def events(self, trial_id: int) -> list[Event]:
        """The events of a trial, in order of time, or `NotFoundError`."""
        with self._database.reading() as connection:
            trials.get(connection, trial_id)
            return trials.events(connection, trial_id)

    # samples

    def samples(self, trial_id: int, channels: Sequence[str] | None = None) -> dict[str, FloatArray]:
        """Channel name -> samples, each of shape (rows,): what is committed now.

        All channels of the trial where `channels` is None.

        Raises:
            NotFoundError: no such trial, or it has no such channel.
        """
        with self._database.reading() as connection:
            trial = trials.get(connection, trial_id)
            return samples.read(connection, trial, trial.channels if channels is None else channels)

    def recording(self, trial_id: int) -> Recording:
        """A trial as a recording set would hold it: its conditions, all its channels, its events.

        Raises:
            NotFoundError: no such trial.
        """
        trial = self.trial(trial_id)
        return Recording(trial.name, trial.kind, dict(trial.conditions), self.samples(trial_id), self.events(trial_id))

    def part(self, trial: Trial, first_row: int, rows: int) -> FloatArray:
        """Some rows of a trial, all its channels, shape (channels, up to `rows`): for whoever goes through all of it.

        Raises:
            NotFoundError: the trial was removed meanwhile.
        """
        with self._database.reading() as connection:
            return samples.read_part(connection, trial, first_row, rows)

    def samples_reduced(
        self, trial_id: int, channels: Sequence[str] | None, points: int, between_s: Stretch | None = None
    ) -> dict[str, FloatArray]:
        """As `samples`, always with time_s, reduced to the rows that a plot needs.

        Args:
            trial_id: the trial.
            channels: all channels of the trial where None.
            points: rows that each channel may ask for, at least 4; all channels share the rows returned.
            between_s: a stretch of the trial [s]; None for all of it.

        Raises:
            NotFoundError: no such trial, or it has no such channel.
            StoreValueError: too few points.
        """
        if points < MIN_POINTS:
            raise StoreValueError(f"points is {points}; wanted at least {MIN_POINTS}")
        with self._database.reading() as connection:
            trial = trials.get(connection, trial_id)
            names = list(dict.fromkeys(["time_s", *(trial.channels if channels is None else channels)]))
            return reduced(connection, trial, names, points, between_s)
