"""What a listener missed while it was away: out of the live buffer where it is still there, else out of the store."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

from bench.runs.live import LiveRows
from bench.store import Store
from bench.store.errors import NotFoundError
from bench.store.records import Trial

CHUNK_ROWS = 2000
MOST_REPLAYED = 200_000  # rows; beyond, the trial is read faster as CSV or Parquet
_PATTERN = re.compile(r"([0-9a-f]{8})\.(-?\d{1,15})\.(\d{1,15})\.(\d{1,15})")


@dataclass(frozen=True, slots=True)
class Mark:
    """Up to where somebody has listened; as text it is the `id` of an event.

    Attributes:
        life: of the service: rows are numbered anew in each.
        row: number of the row in the live buffer; -1 where it came out of the store.
        trial_id: 0 where that is not known.
        trial_rows: rows of that trial that were heard.
    """

    life: str
    row: int
    trial_id: int
    trial_rows: int

    def __str__(self) -> str:
        return f"{self.life}.{self.row}.{self.trial_id}.{self.trial_rows}"

    @classmethod
    def of(cls, life: str, found: LiveRows) -> Self:
        """After live rows."""
        return cls(life, found.last_row, found.trial_id or 0, found.trial_rows)

    @classmethod
    def read(cls, text: str) -> Self | None:
        """From an event's `id`; None where it is none of ours."""
        found = _PATTERN.fullmatch(text)
        return None if found is None else cls(found[1], int(found[2]), int(found[3]), int(found[4]))


@dataclass(frozen=True, slots=True)
class Piece:
    """Rows of one trial out of the store."""

    trial: Trial
    first_row: int
    rows: int


class GapError(Exception):
    """Raised when what was missed cannot be replayed; the message says what is missing, and where it is."""


def missed(store: Store, mark: Mark, now: LiveRows) -> list[Piece]:
    """The rows between a mark and those that are live, oldest first.

    Raises:
        GapError: there is no telling, too many, or they were removed.
    """
    if not mark.trial_id:
        raise GapError("it is not known which rows were missed; the trials are under GET /trials")
    try:
        begun = store.trial(mark.trial_id)
        running = store.trial(now.trial_id) if now.trial_id else None
    except NotFoundError as error:
        raise GapError(f"rows after row {mark.trial_rows} of trial {mark.trial_id} are gone: {error}") from error
    pieces = list(_pieces(store, mark, begun, running, now.trial_rows))
    count = sum(piece.rows for piece in pieces)
    if count > MOST_REPLAYED:
        raise GapError(
            f"{count} rows were missed, from row {mark.trial_rows} of trial {begun.id} on; more than {MOST_REPLAYED} "
            f"are not sent again: read them with GET /trials/{begun.id}/csv"
        )
    return pieces


def _pieces(store: Store, mark: Mark, begun: Trial, running: Trial | None, live_rows: int) -> Iterator[Piece]:
    trials = [one for one in store.trials(begun.experiment_id) if one.id >= begun.id]
    if running is not None and running.experiment_id != begun.experiment_id:
        trials += [one for one in store.trials(running.experiment_id) if one.id <= running.id]
    for trial in trials:
        first = mark.trial_rows if trial.id == begun.id else 0
        end = live_rows if running is not None and trial.id == running.id else trial.rows
        yield from _chunks(trial, first, end)
        if running is not None and trial.id == running.id:
            return


def _chunks(trial: Trial, first_row: int, end: int) -> Iterator[Piece]:
    for start in range(first_row, end, CHUNK_ROWS):
        yield Piece(trial, start, min(CHUNK_ROWS, end - start))


def skipped_experiments(store: Store, mark: Mark, now: LiveRows) -> str:
    """What ran in between and is not replayed, in words; "" where nothing did."""
    if not now.trial_id or not mark.trial_id:
        return ""
    first, last = store.trial(mark.trial_id).experiment_id, store.trial(now.trial_id).experiment_id
    between = [str(one) for one in range(first + 1, last)]
    return f"experiments {between[0]} to {between[-1]} ran meanwhile; see GET /experiments" if between else ""
