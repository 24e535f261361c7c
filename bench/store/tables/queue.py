"""The queue of a bench in the store: what is to be run, in which order, and what became of it."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import datetime
from typing import Any, Protocol

from sqlalchemy import ColumnElement, Connection, Select, delete, func, insert, select, update

from bench.json_types import Json
from bench.store.database import Database
from bench.store.errors import NotFoundError, StoreStateError
from bench.store.schema import CAMPAIGN, EXPERIMENT, QUEUE_ITEM, QUEUE_STATE
from bench.store.tables.experiments import insert_row, now

WAITING, RUNNING = "waiting", "running"
LOST = "the process that ran the queue ended before its experiment was on record"
GONE = "its experiment is not in the store any more"
MOST_WAITING = 10_000  # items of a bench: what is asked of the queue takes longer with each
ITEM = QUEUE_ITEM.c
PLACES = (ITEM.place, ITEM.id)


@dataclass(frozen=True, slots=True)
class Asked:
    """An experiment that is asked for."""

    kind: str
    parameters: Json
    operator: str = ""
    note: str = ""
    tags: list[str] = field(default_factory=list)
    pace: str | None = None


@dataclass(frozen=True, slots=True)
class NewItem(Asked):
    """An experiment to come on a bench.

    Attributes:
        loads: [load_kg, balanced] of its trials, one entry where the next trials have the same.
        lab_claim: of one that was taken from the laboratory's queue.
    """

    duration_s: float = 0.0
    loads: list[list[Any]] = field(default_factory=list)
    lab_claim: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class QueueItem(NewItem):
    """An experiment in the queue, or one that came out of it.

    Attributes:
        campaign_id: that it belongs to; None for a single one.
        state: "waiting", "running", or the outcome of its experiment.
        experiment_id: of its record, once there is one.
    """

    id: int
    campaign_id: int | None
    state: str
    reason: str
    experiment_id: int | None
    created_utc: datetime
    finished_utc: datetime | None


COLUMNS = tuple(ITEM[name] for name in QueueItem.__dataclass_fields__)


class Owners(Protocol):
    """Who runs an item, and whether that process lives: `Custody`."""

    def token(self) -> str:
        """That of this process. Called inside a transaction that writes."""

    def is_mine(self, token: str | None) -> bool:
        """Whether it is that of this process."""

    def lives_elsewhere(self, token: str | None) -> bool:
        """Whether another process lives that goes by it."""

    def forget(self, token: str) -> None:
        """Settle and remove what a dead process left."""


class QueueTable:
    """The queue of one bench. Every method may be called from any thread."""

    def __init__(self, database: Database, owners: Owners, bench: str) -> None:
        self._database = database
        self._owners = owners
        self._bench = bench

    def add(self, items: Sequence[NewItem], campaign: Mapping[str, object] | None = None) -> list[int]:
        """Add items at the end, all or none; a campaign by the columns of its table. Returns their ids.

        Raises:
            StoreStateError: too many would wait.
        """
        with self._database.writing() as connection:
            waiting = connection.execute(_count(self._mine(WAITING))).scalar_one()
            if waiting + len(items) > MOST_WAITING:
                raise StoreStateError(
                    f"{waiting} experiments wait in the queue, and {len(items)} more would be too many; allowed are "
                    f"{MOST_WAITING}. Let it run on, or remove some"
                )
            last = connection.execute(select(func.max(ITEM.place)).where(ITEM.bench == self._bench)).scalar()
            campaign_id = None
            if campaign is not None:
                campaign_id = insert_row(connection, CAMPAIGN, {**campaign, "created_utc": now()})
            common = {"bench": self._bench, "campaign_id": campaign_id, "state": WAITING, "reason": ""}
            rows = [
                {**asdict(item), **common, "place": (last or 0) + number, "created_utc": now()}
                for number, item in enumerate(items, 1)
            ]
            return [insert_row(connection, QUEUE_ITEM, row) for row in rows]

    def items(self, *states: str, campaign_id: int | None = None) -> list[QueueItem]:
        """In the order of the queue; of some states, of a campaign; all without either."""
        where: list[ColumnElement[bool]] = [ITEM.state.in_(states)] if states else []
        if campaign_id is not None:
            where.append(ITEM.campaign_id == campaign_id)
        with self._database.reading() as connection:
            return self._found(connection, *where)

    def count_noted(self, note: str, *states: str) -> int:
        """How many items of some states have a note, word for word."""
        with self._database.reading() as connection:
            return connection.execute(_count(self._mine(*states) & (ITEM.note == note))).scalar_one()

    def ended(self, limit: int) -> list[QueueItem]:
        """What came out of the queue, newest first."""
        newest_first = (ITEM.finished_utc.desc(), ITEM.id.desc())
        with self._database.reading() as connection:
            return self._found(connection, ITEM.state.not_in((WAITING, RUNNING)), order=newest_first, limit=limit)

    def claimed(self, claim: str) -> QueueItem | None:
        """The item that was taken from the laboratory's queue under a claim; None where there is none any more."""
        with self._database.reading() as connection:
            return next(iter(self._found(connection, ITEM.lab_claim == claim)), None)

    def item(self, item_id: int) -> QueueItem:
        """One item, or `NotFoundError`."""
        with self._database.reading() as connection:
            return self._get(connection, item_id)

    def next(self) -> QueueItem | None:
        """What is to be run next; None where nothing waits."""
        with self._database.reading() as connection:
            return next(iter(self._found(connection, ITEM.state == WAITING, limit=1)), None)

    def move(self, item_id: int, to: int) -> None:
        """Move one that waits to a place among those that wait, from 0; beyond the last: to the end.

        Raises:
            NotFoundError: no such item.
            StoreStateError: it does not wait.
        """
        with self._database.writing() as connection:
            self._get_waiting(connection, item_id)
            query = select(ITEM.id, ITEM.place).where(ITEM.bench == self._bench, ITEM.state == WAITING)
            rows = connection.execute(query.order_by(*PLACES)).all()
            order = [row.id for row in rows if row.id != item_id]
            order.insert(to, item_id)
            for row_id, place in zip(order, sorted(row.place for row in rows), strict=True):
                connection.execute(update(QUEUE_ITEM).where(ITEM.id == row_id).values(place=place))

    def change(self, item_id: int, values: Mapping[str, object]) -> None:
        """Change one that waits, as `move`."""
        with self._database.writing() as connection:
            self._get_waiting(connection, item_id)
            connection.execute(update(QUEUE_ITEM).where(ITEM.id == item_id).values(**values))

    def remove(self, item_id: int) -> None:
        """Take one out that waits, as `move`."""
        with self._database.writing() as connection:
            self._get_waiting(connection, item_id)
            connection.execute(delete(QUEUE_ITEM).where(ITEM.id == item_id))

    def clear(self) -> int:
        """Take all out that wait; how many."""
        with self._database.writing() as connection:
            return connection.execute(delete(QUEUE_ITEM).where(self._mine(WAITING))).rowcount

    # what the conductor says

    def begin(self, item_id: int) -> bool:
        """It is being started by this process, as `move`. False, and it waits on, while another process runs one."""
        with self._database.writing() as connection:
            self._get_waiting(connection, item_id)
            if any(self._owners.lives_elsewhere(owner) for _, owner in self._running(connection)):
                return False
            values = {"state": RUNNING, "owner": self._owners.token()}
            connection.execute(update(QUEUE_ITEM).where(ITEM.id == item_id).values(**values))
            return True

    def began(self, item_id: int, experiment_id: int) -> None:
        """Its experiment is on record."""
        self._set(item_id, experiment_id=experiment_id)

    def give_back(self, item_id: int) -> None:
        """It could not be started yet: it waits again, at its place."""
        self._set(item_id, state=WAITING, owner=None)

    def finish(self, item_id: int, outcome: str, reason: str) -> None:
        """It has ended."""
        self._set(item_id, state=outcome, reason=reason, finished_utc=now())

    def settle(self) -> tuple[list[int], list[int]]:
        """Say of items that nobody runs any more what became of them: those of dead processes, and of this one.

        Called while this process runs none. Items of other processes that live are left alone.

        Returns:
            The items that were left, and those that others run.
        """
        with self._database.reading() as connection:
            running = self._running(connection)
        others = [item_id for item_id, owner in running if self._owners.lives_elsewhere(owner)]
        left = [(item_id, owner) for item_id, owner in running if item_id not in others]
        for item_id, owner in left:
            if owner is not None and not self._owners.is_mine(owner):
                self._owners.forget(owner)
            outcome, reason = self._end_of(self.item(item_id).experiment_id)
            self.finish(item_id, outcome, reason)
        return [item_id for item_id, _ in left], others

    def held(self) -> str | None:
        """Why nothing is started; None where it may be."""
        with self._database.reading() as connection:
            row = connection.execute(select(QUEUE_STATE).where(QUEUE_STATE.c.bench == self._bench)).one_or_none()
        return row.reason if row is not None and row.held else None

    def hold(self, reason: str | None) -> None:
        """Start nothing more, and why; None: go on."""
        values = {"held": reason is not None, "reason": reason or "", "changed_utc": now()}
        with self._database.writing() as connection:
            mine = QUEUE_STATE.c.bench == self._bench
            if not connection.execute(update(QUEUE_STATE).where(mine).values(**values)).rowcount:
                connection.execute(insert(QUEUE_STATE).values(bench=self._bench, **values))

    def _end_of(self, experiment_id: int | None) -> tuple[str, str]:
        if experiment_id is None:
            return "interrupted", LOST
        query = select(EXPERIMENT.c.outcome, EXPERIMENT.c.reason).where(EXPERIMENT.c.id == experiment_id)
        with self._database.reading() as connection:
            row = connection.execute(query).one_or_none()
        if row is None:
            return "interrupted", GONE
        return (row.outcome, row.reason) if row.outcome != RUNNING else ("interrupted", LOST)

    def _found(
        self, connection: Connection, *where: Any, order: Sequence[Any] = PLACES, limit: int | None = None
    ) -> list[QueueItem]:
        query = select(*COLUMNS).where(ITEM.bench == self._bench, *where).order_by(*order).limit(limit)
        return [QueueItem(**row._asdict()) for row in connection.execute(query)]

    def _mine(self, *states: str) -> ColumnElement[bool]:
        return (ITEM.bench == self._bench) & ITEM.state.in_(states)

    def _running(self, connection: Connection) -> list[tuple[int, str | None]]:
        """Items that run, each with who runs it."""
        query = select(ITEM.id, ITEM.owner).where(self._mine(RUNNING))
        return [(row.id, row.owner) for row in connection.execute(query.order_by(*PLACES))]

    def _set(self, item_id: int, **values: Any) -> None:
        with self._database.writing() as connection:
            connection.execute(update(QUEUE_ITEM).where(ITEM.id == item_id).values(**values))

    def _get(self, connection: Connection, item_id: int) -> QueueItem:
        for found in self._found(connection, ITEM.id == item_id):
            return found
        raise NotFoundError(f"item {item_id} is not in the queue; list the queue to see what is")

    def _get_waiting(self, connection: Connection, item_id: int) -> None:
        found = self._get(connection, item_id)
        if found.state != WAITING:
            raise StoreStateError(f"item {item_id} is {found.state}; only what waits can be changed, moved or removed")


def _count(which: ColumnElement[bool]) -> Select[int]:
    return select(func.count()).select_from(QUEUE_ITEM).where(which)
