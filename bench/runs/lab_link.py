"""The link of a bench to its laboratory: what it recorded is handed in, and it tells what it does.

The bench never waits for it. While the link is lost the bench goes on, its rows are in its own store, and they are
handed in when the link is back.
"""

import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

from sqlalchemy.exc import SQLAlchemyError

from bench.errors import ConfigurationError
from bench.runs import event_log
from bench.runs.bench_control import BenchControl
from bench.runs.lab_work import LabWork
from bench.runs.lease import Lease
from bench.runs.queue.conductor import Conductor
from bench.store import Store
from bench.store.address import shown
from bench.store.errors import StoreError, StoreUnreachableError
from bench.store.tables.benches import BenchWord, SeenBench
from bench.store.tables.lab_queue import OPEN, LabItem
from bench.store.tables.queue import WAITING
from bench.store.upkeep.hand_in import HandIn

PERIOD_S = 5.0
MOST_SHOWN = 200  # items of the laboratory's queue
LAST_S = 2.0  # how long the end waits for what is under way: what is not handed in by then is handed in later


@dataclass(frozen=True, slots=True)
class LinkState:
    """How the link is.

    Attributes:
        problem: why the laboratory is not reached; "" where it is.
        waiting: experiments that are recorded and not handed in, as last known.
        benches: of the laboratory, as last heard.
        queue: of the laboratory: what waits, is taken or runs, the first of them.
    """

    problem: str = "not reached yet"
    waiting: int = 0
    benches: tuple[SeenBench, ...] = field(default=())
    queue: tuple[LabItem, ...] = field(default=())


def word_of(runner: BenchControl, lease: Lease, conductor: Conductor, waiting: int) -> BenchWord:
    """What a bench that is served does now."""
    status, holder = runner.status(), lease.current()
    runs = status.outcome == "running"
    queued = len(conductor.table.items(WAITING))
    return BenchWord(
        name=runner.configuration.name,
        host=socket.gethostname(),
        state="running" if runs else "idle",
        doing=f"{status.kind}, {100 * status.progress:.0f} %" if runs else "",
        lease="" if holder is None else holder.in_words(),
        queue=", ".join(
            filter(
                None,
                (
                    f"{queued} waiting" if queued else "",
                    conductor.held or "",
                    "takes from the laboratory's" if runner.configuration.store.lab_queue else "",
                ),
            )
        ),
        waiting=waiting,
    )


class LabLink:
    """It has a thread of its own, where there is a laboratory; every method may be called from any thread.

    Args:
        store: of the bench.
        url: database of the laboratory; None: there is none, or the bench writes into it by itself.
        shares: the bench's own store is the laboratory's: it only tells there what it does.
        word: what the bench does now, given how many experiments are to be handed in.
        period_s: between two times that it tells [s].
    """

    def __init__(
        self,
        store: Store,
        url: str | None,
        word: Callable[[int], BenchWord],
        period_s: float = PERIOD_S,
        shares: bool = False,
        work: LabWork | None = None,
    ) -> None:
        self._state = LinkState()
        self._store, self._url, self._word, self._period_s, self._shares = store, url, word, period_s, shares
        self._work = work
        self._lab: Store | None = None
        self._hand: HandIn | None = None
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._run, name="laboratory", daemon=True)

    @property
    def where(self) -> str:
        """How messages name the laboratory; "" where there is none."""
        return shown(self._url) if self._url is not None else "the bench's own store" if self._shares else ""

    @property
    def state(self) -> LinkState:
        """As last heard; of a bench by itself, as it is now."""
        if self.where:
            return self._state
        return LinkState("", 0, (SeenBench(self._word(0), datetime.now(UTC), 0.0),))

    def laboratory(self) -> Store:
        """The laboratory's store.

        Raises:
            ConfigurationError: there is none.
            StoreUnreachableError: it is not reached.
        """
        if not self.where:
            raise ConfigurationError("this bench is by itself; set store.lab_url to the laboratory's database")
        lab = self._lab if self._url is not None else self._store
        if lab is None:
            raise StoreUnreachableError(f"the laboratory is not reached: {self._state.problem}")
        return lab

    def start(self) -> None:
        """Begin to hand in."""
        if self.where:
            self._thread.start()

    def close(self) -> None:
        """Hand in nothing more. Safe to call twice."""
        self._closed.set()
        if self._thread.is_alive():
            self._thread.join(LAST_S)

    def _run(self) -> None:
        while not self._closed.is_set():
            try:
                self._once()
                self._say("")
            except (StoreError, SQLAlchemyError) as error:
                self._say(str(error))
            self._closed.wait(self._period_s)
        if self._lab is not None:
            with suppress(StoreError, SQLAlchemyError):
                self._lab.close()

    def _once(self) -> None:
        if self._url is None:
            self._tell(self._store, 0)
            return
        if self._lab is None:
            self._lab = Store.open(self._url)
        if self._hand is None:
            self._hand = self._store.hand_in_to(self._lab, self._word(0).name)
        waiting = self._hand.waiting()
        self._tell(self._lab, len(waiting))
        for done, experiment_id in enumerate(waiting, 1):
            if self._closed.is_set():
                return
            self._hand.hand_in(experiment_id)
            self._tell(self._lab, len(waiting) - done)

    def _tell(self, lab: Store, waiting: int) -> None:
        lab.benches.tell(self._word(waiting))
        if self._work is not None:
            self._work.look(lab)
        queue = lab.lab_queue.items(*OPEN, limit=MOST_SHOWN)
        self._state = LinkState("", waiting, tuple(lab.benches.all()), tuple(queue))

    def _say(self, problem: str) -> None:
        if bool(problem) != bool(self._state.problem):
            event_log.note("laboratory lost" if problem else "laboratory reached", problem=problem)
        if problem:
            self._state = replace(self._state, problem=problem)
