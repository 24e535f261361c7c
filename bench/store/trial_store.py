"""The trials of a store, and what was measured in them."""

from collections.abc import Mapping, Sequence

import numpy as np
from sqlalchemy import select

from bench.config.channels import known_to_lab
from bench.json_types import Values
from bench.store.database import Database
from bench.store.errors import StoreStateError, StoreValueError
from bench.store.records import Condition, Event, Trial
from bench.store.schema import EXPERIMENT, TRIAL
from bench.store.tables import conditions as condition_rows
from bench.store.tables import days, samples, trial_search, trials
from bench.store.tables.conditions import Wanted
from bench.store.tables.plotted.window import MIN_POINTS, Stretch, reduced
from bench.store.tables.trial_search import TrialQuery
from bench.store.upkeep.custody import Custody
from compensator.lab.recordings.gaps import is_before_gap
from compensator.lab.recordings.recording import FloatArray, Recording

AT_ONCE = 400  # trials that one statement names: databases bound the number of its values


class TrialWriter:
    """A trial that is being recorded. What `append` was given is committed when it returns."""

    def __init__(self, database: Database, trial_id: int, channels: tuple[str, ...]) -> None:
        self.trial_id = trial_id
        self.rows = 0
        self._database = database
        self._channels = channels
        self._pending: FloatArray | None = None  # the newest rows, which the overview does not cover yet
        self._finished = False

    def append(self, rows: FloatArray, events: Sequence[tuple[float, str, str]] = ()) -> None:
        """Write rows, and what happened meanwhile, in one transaction.

        Args:
            rows: shape (n, channels), columns in the order of the trial's channels.
            events: each a time of the trial [s], a name and a detail.

        Raises:
            StoreValueError: the shape does not fit.
            StoreStateError: the trial is finished.
            StoreLockedError, StoreFullError, StoreReadOnlyError: nothing of all this is kept.
        """
        samples.check_shape(rows, len(self._channels))
        self._check_running()
        if len(rows) == 0 and not events:
            return
        with self._database.recording() as connection:
            pending = samples.add(connection, self.trial_id, self.rows, rows, self._pending)
            trials.add_events(connection, self.trial_id, [Event(*event) for event in events])
        self._pending = pending
        self.rows += len(rows)

    def finish(self, outcome: str, reason: str = "", results: Values | None = None) -> None:
        """Close the trial.

        Args:
            outcome: any of `OUTCOMES` but "running".
            reason: why it ended.
            results: JSON-able, units in the names; NaN is kept as null.

        Raises:
            StoreStateError: the trial is finished already.
            StoreValueError: an outcome that does not exist.
        """
        self._check_running()
        with self._database.writing() as connection:
            trials.finish(connection, self.trial_id, outcome, reason, results or {})
        self._finished = True

    def _check_running(self) -> None:
        if self._finished:
            raise StoreStateError(f"trial {self.trial_id} is finished; begin a new one for more rows")


class TrialStore:
    """Trials, their samples and their events; `Store` is one."""

    custody: Custody
    _database: Database

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
            channels: names from `bench.config.channels.KEPT`, in the order of the columns of the rows.

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

    def trials_of(self, trial_ids: Sequence[int]) -> list[Trial]:
        """Trials in the order of their ids in a list, or `NotFoundError`."""
        with self._database.reading() as connection:
            starts = range(0, len(trial_ids), AT_ONCE)
            found = [one for start in starts for one in trials.of_ids(connection, trial_ids[start : start + AT_ONCE])]
            for missing in set(trial_ids).difference(one.id for one in found):
                trials.get(connection, missing)
        return list(map(self.custody.as_ended, found))

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
        wanted = TrialQuery(experiment_id, kind, outcome, conditions=conditions or {})
        with self._database.reading() as connection:
            filters = trial_search.filters(connection, wanted)
            if source is not None:
                of_source = select(EXPERIMENT.c.id).where(EXPERIMENT.c.source == source)
                filters.append(TRIAL.c.experiment_id.in_(of_source))
            # the page is found in indexes alone, then its rows are read: a late page costs no more than an early one
            page = select(TRIAL.c.id).where(*filters).order_by(TRIAL.c.id).limit(limit).offset(offset).subquery()
            rows = connection.execute(select(TRIAL).join(page, page.c.id == TRIAL.c.id).order_by(TRIAL.c.id)).all()
            found = condition_rows.of_trials(connection, [row.id for row in rows])
        return [self.custody.as_ended(trials.record(row, found)) for row in rows]

    def search_trials(self, wanted: TrialQuery, limit: int, offset: int = 0) -> tuple[list[Trial], int]:
        """One page of the trials that are looked for, sorted, and how many there are in all.

        Raises:
            StoreValueError: an unknown order, or too many words.
        """
        with self._database.reading() as connection:
            ids, count = trial_search.search(connection, wanted, limit, offset)
            found = trials.of_ids(connection, ids)
        return list(map(self.custody.as_ended, found)), count

    def days(self, offset_min: int = 0, limit: int = 60) -> list[days.Day]:
        """The newest days on which something was begun, newest first.

        Args:
            offset_min: of the local time that days are counted in, ahead of UTC [min].
            limit: days at most.
        """
        with self._database.reading() as connection:
            return days.days(connection, offset_min, limit)

    def events(self, trial_id: int) -> list[Event]:
        """The events of a trial, in order of time, or `NotFoundError`."""
        with self._database.reading() as connection:
            trials.get(connection, trial_id)
            return trials.events(connection, trial_id)

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
        """A trial as the model lab takes it: its conditions, its events, and the channels that the lab knows.

        Raises:
            NotFoundError: no such trial.
        """
        with self._database.reading() as connection:
            trial = trials.get(connection, trial_id)
            measured = samples.read(connection, trial, known_to_lab(trial.channels))
            events = trials.events(connection, trial_id)
        return Recording(trial.name, trial.kind, dict(trial.conditions), measured, events)

    def part(self, trial: Trial, first_row: int, rows: int) -> FloatArray:
        """Some rows of a trial, all its channels, shape (channels, up to `rows`): for whoever goes through all of it.

        Raises:
            NotFoundError: the trial was removed meanwhile.
        """
        with self._database.reading() as connection:
            return samples.read_part(connection, trial, first_row, rows)

    def time_gaps(self, trial_id: int) -> list[Stretch]:
        """Between which times [s] of a trial nothing was recorded, by the rule of the model lab.

        Raises:
            NotFoundError: no such trial.
        """
        time_s = self.samples(trial_id, ["time_s"])["time_s"]
        if len(time_s) < 2:
            return []
        return [(float(time_s[row]), float(time_s[row + 1])) for row in np.flatnonzero(is_before_gap(time_s))]

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
