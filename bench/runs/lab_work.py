"""Work from the laboratory's queue: a bench whose owner said so takes what fits, one at a time, while it is free.

What is taken stands in the bench's own queue, and is run as everything there: under the bench's limits, with its lease,
held by STOP. It is begun only once the laboratory has confirmed, a moment before, that it is still this bench's.
"""

from collections.abc import Callable
from dataclasses import replace

from sqlalchemy.exc import SQLAlchemyError

from bench.config.configuration import BenchConfiguration
from bench.errors import BenchError
from bench.runs.bench_control import PACES
from bench.runs.queue.conductor import Conductor
from bench.runs.queue.items import checked_item
from bench.store import Store
from bench.store.errors import NotFoundError, StoreError, StoreStateError
from bench.store.tables.lab_queue import TAKEN, LabItem, LabQueueTable, Taker
from bench.store.tables.queue import RUNNING, WAITING, NewItem, QueueItem

TAKEN_OUT = "taken out of the bench's own queue"


class LabWork:
    """What a bench has of the laboratory's queue. `look` is called by one thread, `begin` by the conductor's.

    Args:
        configuration: of the bench; `store.lab_queue` says whether it takes anything.
        conductor: of its own queue.
        is_free: whether nothing runs or is about to, nobody has the bench, and its queue is not held.
    """

    def __init__(self, configuration: BenchConfiguration, conductor: Conductor, is_free: Callable[[], bool]) -> None:
        places = configuration.store
        self._configuration, self._conductor, self._is_free = configuration, conductor, is_free
        self._taker = Taker(configuration.name, configuration.rig.name, frozenset(places.lab_tags))
        self._takes = places.lab_queue
        self._added: set[str] = set()  # claims of items that stand in the bench's queue, by this process
        self._lab: LabQueueTable | None = None
        conductor.confirm = self.begin

    def look(self, lab: Store) -> None:
        """Say what became of what it has, and take more where it may.

        Raises:
            StoreError: the laboratory, or the bench's own store, does not answer; call again, later.
        """
        queue = self._lab = lab.lab_queue
        mine = queue.items(TAKEN, RUNNING, bench=self._taker.name)
        for item in mine:
            self._settle(queue, item)
        if self._takes and not mine and self._is_free() and not self._conductor.table.items(WAITING, RUNNING):
            self._take(queue)

    def begin(self, claim: str) -> bool:
        """Whether the experiment of an item may start now. Where that is not sure, it may not."""
        try:
            if self._lab is not None and self._lab.begin(claim):
                return True
        except (StoreError, SQLAlchemyError):
            pass  # nobody knows whether the laboratory took note: `_settle` gives it back
        self._added.discard(claim)
        return False

    def _settle(self, queue: LabQueueTable, item: LabItem) -> None:
        own = self._conductor.table.claimed(item.claim)
        if own is None:
            why = TAKEN_OUT if item.claim in self._added else ""
            self._added.discard(item.claim)
            queue.give_back(item.claim, self._taker.name, why)
        elif own.state == WAITING and not self._is_free():
            self._withdraw(queue, item, own)
        elif own.state in (WAITING, RUNNING):
            queue.renew(item.claim)
        else:
            queue.finish(item.claim, own.state, own.reason, own.experiment_id)

    def _withdraw(self, queue: LabQueueTable, item: LabItem, own: QueueItem) -> None:
        """Give back what would have to wait here: another bench may be free."""
        try:
            self._conductor.table.remove(own.id)
        except (NotFoundError, StoreStateError):
            return  # it has just been begun
        self._added.discard(item.claim)
        queue.give_back(item.claim)

    def _take(self, queue: LabQueueTable) -> None:
        """The first one that this bench's own limits let pass; the others are declined, with the reason."""
        while (item := queue.take(self._taker)) is not None:
            pace = next((one for one in PACES if one == item.pace), None)
            order = NewItem(item.kind, item.parameters, item.operator, item.note, item.tags, pace)
            try:
                checked = checked_item(order, self._configuration)
            except StoreError:
                raise
            except BenchError as error:
                queue.give_back(item.claim, self._taker.name, str(error))
                continue
            self._added.add(item.claim)
            self._conductor.add_items([replace(checked, lab_claim=item.claim)])
            return
