"""Who runs which experiment, and how those end whose end could not be written.

An end that the database does not take (a full disk, a lock, a file that was taken away) is noted in the
claim's file beside the database, which has the room for it from the start. It is written to the database
at the next possibility: before the next experiment, when the store is closed, or by whoever opens it next.
"""

import threading
from contextlib import suppress
from dataclasses import replace
from typing import TypeVar

from bench.store.backend import Claim
from bench.store.database import Database
from bench.store.errors import (
    StoreError,
    StoreFileError,
    StoreFullError,
    StoreLockedError,
    StoreReadOnlyError,
    StoreStateError,
    StoreUnreachableError,
)
from bench.store.records import Experiment, Trial
from bench.store.tables import experiments
from bench.store.upkeep.retention import remove

# what keeps an end out of the database, though nothing is wrong with the end
UNWRITTEN = (StoreFileError, StoreFullError, StoreLockedError, StoreReadOnlyError, StoreUnreachableError)
LEFT_RUNNING = "the process that ran it ended without closing it (killed, crashed, or the power went)"
CLOSED = "the store was closed while it ran"
Record = TypeVar("Record", Experiment, Trial)
End = tuple[str, str]  # outcome, reason


class Custody:
    """The experiments that one store runs, and those that dead processes left."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self._claim: Claim | None = None
        self._claiming = threading.Lock()
        self._closed = False
        self._unwritten: dict[int, End] = {}

    def token(self) -> str:
        """The token under which this store runs experiments. Called inside a transaction that writes.

        Raises:
            StoreStateError: the store was closed: nobody would let go of a claim.
        """
        with self._claiming:
            if self._closed:
                raise StoreStateError(f"store '{self._database.where}' was closed; open it again")
            if self._claim is not None and not self._claim.holds():
                self._claim.release(keep_note=True)  # the server ended its session
                self._claim = None
            self._claim = self._claim or self._database.claim()
            return self._claim.token

    def lives_elsewhere(self, token: str | None) -> bool:
        """Whether another process lives, or another store of this one, that goes by a token."""
        return not self.is_mine(token) and self._database.backend.lives(token)

    def is_mine(self, token: str | None) -> bool:
        """Whether this store goes by a token."""
        return self._claim is not None and self._claim.token == token

    def forget(self, token: str) -> None:
        """Settle and remove what a dead process left."""
        self.settle()
        self._database.backend.forget(token)

    def note(self, experiment_id: int, outcome: str, reason: str) -> None:
        """Keep an end that the database did not take."""
        self._unwritten[experiment_id] = (outcome, reason)
        self._note_all()

    def as_ended(self, record: Record) -> Record:
        """A record with the end that the database lacks."""
        if record.outcome != "running":
            return record
        experiment_id = record.id if isinstance(record, Experiment) else record.experiment_id
        # the control loop may be in another process, and the database full or locked for it
        end = self._unwritten.get(experiment_id) or self._last_words(self._tokens()).get(experiment_id)
        return record if end is None else replace(record, outcome=end[0], reason=end[1])

    def write_noted(self) -> None:
        """Write the ends that the database did not take, if it takes them now. Nothing to do, mostly."""
        for experiment_id, (outcome, reason) in list(self._unwritten.items()):
            try:
                with suppress(StoreStateError), self._database.writing() as connection:
                    experiments.finish(connection, experiment_id, outcome, reason, {})
            except StoreError:
                return
            del self._unwritten[experiment_id]
            self._note_all()

    def settle(self, reason: str = LEFT_RUNNING) -> None:
        """End what dead processes left running, as they noted it or as interrupted; remove their half imports."""
        backend = self._database.backend
        self._settle({token for token in self._tokens() if not backend.lives(token)}, reason)

    def close(self) -> None:
        """End what this store left running, and let go of the claim. Safe to call twice."""
        with self._claiming:
            self._closed = True
        if self._claim is None:
            return
        with suppress(StoreError):  # a full or locked database: the next to open it does this
            self.write_noted()
            self._settle({self._claim.token}, CLOSED)
        self._claim.release(keep_note=bool(self._unwritten))
        self._claim = None

    def _last_words(self, tokens: set[str | None]) -> dict[int, End]:
        noted: dict[int, End] = {}
        for token in tokens:
            noted |= self._database.backend.last_words(token)
        return noted

    def _note_all(self) -> None:
        if self._claim is not None:
            with suppress(OSError):  # the folder is gone: then this process alone knows
                self._claim.note(self._unwritten)

    def _tokens(self) -> set[str | None]:
        with self._database.reading() as connection:
            return {token for _, token, _ in experiments.unfinished(connection)}

    def _settle(self, tokens: set[str | None], reason: str) -> None:
        if not tokens & self._tokens():
            return
        noted, hidden = self._last_words(tokens), []
        with self._database.writing() as connection:
            for experiment_id, token, outcome in experiments.unfinished(connection):
                if token not in tokens:
                    continue
                if outcome == "running":
                    end = noted.get(experiment_id, ("interrupted", reason))
                    experiments.finish(connection, experiment_id, *end, {})
                else:
                    hidden.append(experiment_id)
        for token in tokens:
            self._database.backend.forget(token)
        for experiment_id in hidden:
            remove(self._database, experiment_id)
