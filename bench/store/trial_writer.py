"""Where the rows and events of a running trial go."""

from collections.abc import Sequence

from bench.json_types import Values
from bench.store.database import Database
from bench.store.errors import StoreStateError
from bench.store.records import Event
from bench.store.tables import samples, trials
from compensator.lab.recordings.recording import FloatArray


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
