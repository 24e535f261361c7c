"""The queue of a laboratory: experiments that whichever bench fits takes, each exactly once.

An item waits until a bench takes it. The bench says again and again that it still has it; one that is not heard of
loses it, as long as it has not begun. To begin, it asks with the claim that it was given: a bench that was away for so
long that another took the item is refused then. What has begun is never given out again, whatever becomes of its bench.
"""

import secrets
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, and_, delete, func, select, update

from bench.store.database import Database
from bench.store.errors import NotFoundError, StoreStateError
from bench.store.schema import HANDED_IN, LAB_ITEM
from bench.store.tables.benches import LOST_S
from bench.store.tables.experiments import insert_row, now
from bench.store.tables.queue import RUNNING, WAITING, Asked

TAKEN = "taken"
OPEN = (WAITING, TAKEN, RUNNING)
GIVEN_UP = "its bench was lost while it ran, and it was given up"
ITEM = LAB_ITEM.c


@dataclass(frozen=True, slots=True)
class NewLabItem(Asked):
    """An experiment for a bench of the laboratory.

    Attributes:
        for_bench, for_rig: name of the bench, of its rig; "": any.
        for_tags: what a bench has to have among the `lab_tags` of its configuration.
    """

    asked_by: str = ""
    for_bench: str = ""
    for_rig: str = ""
    for_tags: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Taker:
    """A bench that takes work: its name, that of its rig, and its tags."""

    name: str
    rig: str
    tags: frozenset[str]

    def fits(self, item: "LabItem") -> bool:
        """Whether an item is for it, and was not declined by it."""
        asked = item.for_bench in ("", self.name) and item.for_rig in ("", self.rig)
        return asked and self.tags.issuperset(item.for_tags) and self.name not in item.declined


@dataclass(frozen=True, slots=True, kw_only=True)
class LabItem(NewLabItem):
    """An item of the laboratory's queue, or one that came out of it.

    Attributes:
        state: "waiting"; "taken" by a bench that has not begun; "running"; or the outcome of its experiment.
        bench: that has it or had it; "" where none has.
        origin_id: of the experiment, in the store of that bench.
        declined: by bench, why it does not take it.
        silent_s: since its bench last said that it has it [s]; None where none has.
        experiment_id: of the experiment in the laboratory, once it is handed in.
    """

    id: int
    state: str
    reason: str
    bench: str
    claim: str
    origin_id: int | None
    declined: dict[str, str]
    created_utc: datetime
    finished_utc: datetime | None
    silent_s: float | None
    experiment_id: int | None

    @property
    def is_left(self) -> bool:
        """Whether its bench has not been heard of for so long that it counts as lost."""
        return self.silent_s is not None and self.silent_s > LOST_S


COLUMNS = tuple(ITEM[name] for name in LabItem.__dataclass_fields__ if name not in ("silent_s", "experiment_id"))


class LabQueueTable:
    """The queue of the laboratory. Every method may be called from any thread, of any bench."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, items: Sequence[NewLabItem]) -> list[int]:
        """Add items at the end, all or none. Returns their ids."""
        fresh = {"state": WAITING, "reason": "", "bench": "", "claim": "", "declined": {}, "created_utc": now()}
        with self._database.writing(durable=True) as connection:
            return [insert_row(connection, LAB_ITEM, {**asdict(item), **fresh}) for item in items]

    def items(self, *states: str, bench: str | None = None, limit: int | None = None) -> list[LabItem]:
        """In the order in which they were added; of some states, of a bench."""
        with self._database.reading() as connection:
            return _items(connection, *_of(states, bench), limit=limit)

    def ended(self, limit: int) -> list[LabItem]:
        """What came out of the queue, newest first."""
        with self._database.reading() as connection:
            return _items(connection, ITEM.state.not_in(OPEN), limit=limit, newest_first=True)

    def remove(self, item_id: int) -> None:
        """Take one out that no bench has; or give one up whose bench was lost while it ran.

        Raises:
            NotFoundError: no such item.
            StoreStateError: a bench has it, or it has ended.
        """
        with self._database.writing(durable=True) as connection:
            found = _items(connection, ITEM.id == item_id)
            if not found:
                raise NotFoundError(f"item {item_id} is not in the laboratory's queue; list it to see what is")
            (item,) = found
            if item.state == WAITING or (item.state == TAKEN and item.is_left):
                connection.execute(delete(LAB_ITEM).where(ITEM.id == item_id))
            elif item.state == RUNNING and item.is_left:
                values = {"state": "interrupted", "reason": GIVEN_UP, "finished_utc": now(), "claim": ""}
                connection.execute(update(LAB_ITEM).where(ITEM.id == item_id).values(**values))
            else:
                has = f"bench '{item.bench}' has it; stop it there" if item.state in OPEN else "it has ended"
                raise StoreStateError(f"item {item_id} is {item.state}: {has}")

    # what a bench says

    def take(self, taker: Taker) -> LabItem | None:
        """The first item that fits, taken by this bench; None where there is none.

        All writers of a database take turns: no two benches are given the same item.
        """
        with self._database.reading() as connection:  # to look costs no turn
            if not any(map(taker.fits, _free(connection))):
                return None
        with self._database.writing(durable=True) as connection:
            item = next(filter(taker.fits, _free(connection)), None)
            if item is None:
                return None
            values = {"state": TAKEN, "bench": taker.name, "claim": secrets.token_hex(16), "renewed_utc": func.now()}
            connection.execute(update(LAB_ITEM).where(ITEM.id == item.id).values(**values))
            (taken,) = _items(connection, ITEM.id == item.id)
            return taken

    def renew(self, claim: str) -> bool:
        """The bench still has it. False where another one has by now."""
        return self._change(claim, {"renewed_utc": func.now()}, OPEN)

    def begin(self, claim: str) -> bool:
        """Its experiment is about to start. False where another bench has it by now: it may not start then."""
        return self._change(claim, {"state": RUNNING, "renewed_utc": func.now()}, (TAKEN,))

    def give_back(self, claim: str, bench: str = "", why: str = "") -> bool:
        """It has not started, and waits again; with a reason, the bench does not take it any more."""
        with self._database.writing(durable=True) as connection:
            for item in _items(connection, ITEM.claim == claim):
                declined = {**item.declined, bench: why} if why else item.declined
                values = {"state": WAITING, "bench": "", "claim": "", "renewed_utc": None, "declined": declined}
                connection.execute(update(LAB_ITEM).where(ITEM.id == item.id).values(**values))
                return True
        return False

    def finish(self, claim: str, outcome: str, reason: str, origin_id: int | None) -> bool:
        """It has ended."""
        values = {"state": outcome, "reason": reason, "origin_id": origin_id, "finished_utc": now(), "claim": ""}
        return self._change(claim, values, (TAKEN, RUNNING))

    def _change(self, claim: str, values: Mapping[str, object], states: Sequence[str]) -> bool:
        mine = and_(ITEM.claim == claim, ITEM.state.in_(states))
        with self._database.writing(durable=True) as connection:
            return bool(connection.execute(update(LAB_ITEM).where(mine).values(**values)).rowcount)


def _of(states: Sequence[str], bench: str | None) -> list[Any]:
    return [*([ITEM.state.in_(states)] if states else []), *([ITEM.bench == bench] if bench is not None else [])]


def _free(connection: Connection) -> list[LabItem]:
    """What a bench may take: what waits, and what was taken by one that is lost and had not begun."""
    return [one for one in _items(connection, ITEM.state.in_((WAITING, TAKEN))) if one.state == WAITING or one.is_left]


def _items(connection: Connection, *where: Any, limit: int | None = None, newest_first: bool = False) -> list[LabItem]:
    handed = (
        select(func.max(HANDED_IN.c.experiment_id))
        .where(HANDED_IN.c.bench == ITEM.bench, HANDED_IN.c.origin_id == ITEM.origin_id, HANDED_IN.c.complete)
        .scalar_subquery()
    )
    clock = func.now(type_=ITEM.created_utc.type).label("now_utc")
    columns: tuple[Any, ...] = (*COLUMNS, ITEM.renewed_utc, clock, handed.label("experiment_id"))
    query = select(*columns).where(*where)
    order = (ITEM.finished_utc.desc(), ITEM.id.desc()) if newest_first else (ITEM.id,)
    return [_item(row) for row in connection.execute(query.order_by(*order).limit(limit))]


def _item(found: Row[Any]) -> LabItem:
    row = found._asdict()
    renewed_utc, now_utc = row.pop("renewed_utc"), row.pop("now_utc")
    has = row["state"] in (TAKEN, RUNNING) and renewed_utc is not None
    return LabItem(**row, silent_s=(now_utc - renewed_utc).total_seconds() if has else None)
