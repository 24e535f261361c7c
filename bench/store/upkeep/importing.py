"""An experiment that was recorded elsewhere comes in: all of it, or nothing, in transactions of bounded size.

Nobody sees it before it is complete. What a dead process left is removed by whoever opens the store next. A trial is
hashed as soon as it is there, as it will be when it is seen, and outside any transaction that writes: the last one only
enters in the chain what is known.
"""

from collections.abc import Callable, Generator, Iterable, Mapping
from typing import TypeVar

from sqlalchemy import bindparam, update

from bench.store.database import Database
from bench.store.errors import StoreStateError
from bench.store.records import IMPORTING, Event, NewExperiment
from bench.store.schema import TRIAL
from bench.store.tables import chain, experiments, samples, trials
from bench.store.tables.experiments import check_outcome, now
from bench.store.upkeep.retention import remove
from compensator.lab.recordings.recording import Recording

TRANSACTION_BYTES = 16 * 2**20  # a bench that records meanwhile waits for one of these, not for the whole
EVENT_BYTES = 2048  # bytes of samples that take as long to write as an event

ItemT = TypeVar("ItemT")


class Import:
    """An import under way."""

    def __init__(self, database: Database, owner: str, new: NewExperiment) -> None:
        self._database = database
        self._ends: list[dict[str, object]] = []
        self._digests: dict[int, str] = {}
        with database.writing() as connection:
            self.experiment_id = experiments.add(connection, owner, new, IMPORTING)

    def add(self, recording: Recording, outcome: str, reason: str) -> None:
        """Add a trial.

        Raises:
            StoreValueError: it cannot be kept; call `abandon`.
            StoreStateError: another process took this one for dead, and removed what came in.
        """
        check_outcome(outcome)
        what = (recording.name, recording.kind, recording.conditions, tuple(recording.channels))
        with self._database.writing() as connection:
            trial_id = trials.add(connection, self.experiment_id, *what, outcome=IMPORTING)
        for events in parts(recording.events, _event_bytes, TRANSACTION_BYTES):
            with self._database.recording() as connection:
                trials.add_events(connection, trial_id, events)
        share = max(1, TRANSACTION_BYTES // (8 * max(1, len(recording.channels))))
        pending = None
        for start in range(0, len(recording), share):
            rows = samples.rows_of(recording.channels, start, share)
            with self._database.recording() as connection:
                pending = samples.add(connection, trial_id, start, rows, pending)
        self._hash(trial_id, {"outcome": outcome, "reason": reason, "finished_utc": now()})

    def finish(self) -> int:
        """Let it be seen. Returns the experiment's number."""
        end = update(TRIAL).where(TRIAL.c.id == bindparam("trial"))
        end = end.values({name: bindparam(f"its_{name}") for name in ("outcome", "reason", "finished_utc")})
        with self._database.writing() as connection:
            if self._ends:
                connection.execute(end, self._ends)
            experiments.show(connection, self.experiment_id, self._digests)
        return self.experiment_id

    def abandon(self) -> None:
        """Remove what came in so far."""
        remove(self._database, self.experiment_id)

    def _hash(self, trial_id: int, end: Mapping[str, object]) -> None:
        """Note what a trial is once it has its end."""
        with self._database.reading() as connection:
            digest = chain.digest_of(connection, "trial", trial_id, end)
        if digest is None:
            raise StoreStateError(f"the trial {trial_id} was removed by another process meanwhile; import it again")
        self._digests[trial_id] = digest
        self._ends.append({"trial": trial_id, **{f"its_{name}": value for name, value in end.items()}})


def _event_bytes(event: Event) -> int:
    return EVENT_BYTES + len(event.name) + len(event.detail)


def parts(items: Iterable[ItemT], size_of: Callable[[ItemT], int], most: int) -> Generator[list[ItemT], None, None]:
    """So many of some items at a time as one transaction takes: the one that makes it full is the last."""
    part: list[ItemT] = []
    size = 0
    for item in items:
        part.append(item)
        size += size_of(item)
        if size >= most:
            yield part
            part, size = [], 0
    if part:
        yield part
