"""An experiment that was recorded elsewhere comes in: all of it, or nothing, in transactions of bounded size.

Nobody sees it before it is complete. What a dead process left is removed by whoever opens the store next.
"""

from sqlalchemy import bindparam, update

from bench.store.database import Database
from bench.store.records import IMPORTING, NewExperiment
from bench.store.schema import TRIAL
from bench.store.tables import experiments, samples, trials
from bench.store.tables.experiments import check_outcome, now
from bench.store.upkeep.retention import remove
from compensator.lab.recordings.recording import Recording

TRANSACTION_BYTES = 16 * 2**20  # a bench that records meanwhile waits for one of these, not for the whole


class Import:
    """An import under way.

    Attributes:
        experiment_id: its number.
    """

    def __init__(self, database: Database, owner: str, new: NewExperiment) -> None:
        self._database = database
        self._ends: list[dict[str, object]] = []
        with database.writing() as connection:
            self.experiment_id = experiments.add(connection, owner, new, IMPORTING)

    def add(self, recording: Recording, outcome: str, reason: str) -> None:
        """Add a trial.

        Raises:
            StoreValueError: it cannot be kept; call `abandon`.
        """
        check_outcome(outcome)
        what = (recording.name, recording.kind, recording.conditions, tuple(recording.channels))
        with self._database.writing() as connection:
            trial_id = trials.add(connection, self.experiment_id, *what, outcome=IMPORTING)
            trials.add_events(connection, trial_id, recording.events)
        self._ends.append({"trial": trial_id, "ended": outcome, "why": reason})
        share = max(1, TRANSACTION_BYTES // (8 * max(1, len(recording.channels))))
        pending = None
        for start in range(0, len(recording), share):
            rows = samples.rows_of(recording.channels, start, share)
            with self._database.recording() as connection:
                pending = samples.add(connection, trial_id, start, rows, pending)

    def finish(self) -> int:
        """Let it be seen. Returns the experiment's number."""
        end = update(TRIAL).where(TRIAL.c.id == bindparam("trial"))
        end = end.values(outcome=bindparam("ended"), reason=bindparam("why"), finished_utc=now())
        with self._database.writing() as connection:
            if self._ends:
                connection.execute(end, self._ends)
            experiments.show(connection, self.experiment_id)
        return self.experiment_id

    def abandon(self) -> None:
        """Remove what came in so far."""
        remove(self._database, self.experiment_id)
