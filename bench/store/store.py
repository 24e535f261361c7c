"""The store: everything that was measured, and every model made from it."""

from types import TracebackType
from typing import Self

from bench.store.address import database_of
from bench.store.database import Database
from bench.store.experiment_store import ExperimentStore
from bench.store.migration import migrate
from bench.store.study_store import StudyStore
from bench.store.tables.access_tokens import AccessTokens
from bench.store.tables.audit import Audit
from bench.store.tables.benches import Benches
from bench.store.tables.calibrations import Calibrations
from bench.store.tables.lab_queue import LabQueueTable
from bench.store.tables.queue import QueueTable
from bench.store.tables.start_keys import StartKeys
from bench.store.trial_store import TrialStore
from bench.store.upkeep.custody import Custody
from bench.store.upkeep.hand_in import HandIn
from bench.store.upkeep.removal import Removal
from bench.store.upkeep.retention import Retention
from bench.store.upkeep.space import SpaceNeed
from bench.store.upkeep.upkeep import Upkeep


class AccessRecords:
    """`Store.access`."""

    def __init__(self, database: Database) -> None:
        self.tokens = AccessTokens(database)
        self.audit = Audit(database)
        self.start_keys = StartKeys(database)


BUSY_TIMEOUT_S = 10.0


class Store(ExperimentStore, TrialStore, StudyStore):
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

        A file that may not be written is read as it is.

        Args:
            url: "sqlite:///bench.sqlite", or "postgresql://user@host/database".
            busy_timeout_s: how long a write waits for another one before `StoreLockedError` [s].

        Raises:
            StoreFileError: no such folder, no database, a database of another program, or a damaged one.
            StoreVersionError: made by a newer version.
            StoreLockedError, StoreFullError, StoreReadOnlyError, StoreUnreachableError
        """
        store = cls(database_of(url, busy_timeout_s))
        try:
            migrate(store._database)
            if not store._database.backend.is_read_only:
                store.custody.settle()
        except BaseException:
            store.close()
            raise
        return store

    @property
    def where(self) -> str:
        """The file, or the server's address without its password."""
        return self._database.where

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

    @property
    def removal(self) -> Removal:
        """Removing one experiment or one study."""
        return Removal(self._database)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def benches(self) -> Benches:
        """The benches that share this store."""
        return Benches(self._database)

    @property
    def lab_queue(self) -> LabQueueTable:
        """The queue of the laboratory whose store this is."""
        return LabQueueTable(self._database)

    def hand_in_to(self, lab: "Store", bench: str) -> HandIn:
        """From this store of a bench to that of the laboratory."""
        return HandIn(self._database, lab._database, bench)

    def queue(self, bench: str) -> QueueTable:
        """The queue of a bench."""
        return QueueTable(self._database, self.custody, bench)
