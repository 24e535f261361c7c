"""Runs what the queue holds, one after the other; whatever goes wrong holds the queue, and says why."""

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import cast

from bench.errors import BenchError, BusyError
from bench.runs.bench_control import BenchControl, Pace
from bench.runs.lease import LeaseHeldError
from bench.runs.queue.items import checked_item
from bench.store import Store
from bench.store.errors import NotFoundError, StoreError, StoreStateError
from bench.store.tables.queue import WAITING, NewItem, QueueItem, QueueTable
from drivers.errors import DriveError

RESTARTED = "the service was started anew; look at the bench, then resume"
LEFT = "the process that ran item {} of this queue has ended; look at the bench, then resume"
ELSEWHERE = "item {} of this queue is run by another process"
STOPPED = "stopped"
LABORATORY = "the laboratory's queue"
BUSY_S = 0.2  # until a bench is asked again that runs something that is not of the queue
Starting = Callable[[str], AbstractContextManager[object]]
"""Entered round each start with the name of who lets the queue run; raises `LeaseHeldError` where that may not be."""


class Conductor:
    """The queue in operation. It has a thread of its own; every method may be called from any thread.

    The queue is held, and nothing of it starts: after a start of the service with something in it, after whatever did
    not complete, and after STOP. Then somebody has to resume it.

    Attributes:
        confirm: whether an item of the laboratory's queue, by its claim, may start now; asked before each.
        elsewhere: which item another process runs while this one waits for it, in words.
    """

    def __init__(self, runner: BenchControl, store: Store, starting: Starting = lambda _name: nullcontext()) -> None:
        self.table: QueueTable = store.queue(runner.configuration.name)
        self.running: QueueItem | None = None
        self.elsewhere = ""
        self.confirm: Callable[[str], bool] = lambda _claim: False
        self._runner, self._store, self._starting = runner, store, starting
        self._held: str | None = None
        self._kept: str | None = None  # as the store has it
        self._stop: str | None = None  # asked for, and not yet honoured by what was being started
        self._acting_for = ""
        self._hung: tuple[float, bool] | None = None
        self._wake, self._closed = threading.Event(), False
        self._thread = threading.Thread(target=self._run, name="queue", daemon=True)

    def begin(self) -> None:
        """Take up the queue as it is in the store.

        Raises:
            StoreError: it cannot be read.
        """
        left, _ = self.table.settle()
        self._held = self._kept = self.table.held()
        if left or (self._held is None and self.table.items(WAITING)):
            self._held = RESTARTED
        self._thread.start()
        self._wake.set()

    def end(self) -> None:
        """Start nothing more; what runs is the runner's to end. Takes no lock: safe in a signal handler."""
        self._closed = True

    def close(self) -> None:
        """Start nothing more, and wait for the end of what runs."""
        self.end()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join()

    @property
    def held(self) -> str | None:
        """Why nothing of the queue is started; None where it goes on."""
        return self._held

    def add(self, orders: list[NewItem], by: str = "") -> list[int]:
        """Take orders in, all or none. They start at once where the queue is neither held nor busy. Returns their ids.

        Raises:
            UnknownKindError, ParameterError, LimitError, ConfigurationError: one is refused.
            StoreStateError: too many would wait.
        """
        return self.add_items([checked_item(order, self._runner.configuration) for order in orders], by=by)

    def add_items(self, items: list[NewItem], campaign: dict[str, object] | None = None, by: str = "") -> list[int]:
        """Take items in, all or none; a campaign by the columns of its table. Returns their ids.

        Raises:
            StoreStateError: too many would wait.
        """
        found = self.table.add(items, campaign)
        self._acting_for = by or self._acting_for
        self._wake.set()
        return found

    def pause(self, reason: str) -> None:
        """Stand still after the trial that runs, with the power off, and start nothing more."""
        if self._held is None:
            self._held = reason
        if self.running is not None:
            self._runner.pause()
        self._wake.set()

    def resume(self, by: str = "") -> None:
        """Go on: the joint moves."""
        self._acting_for = by or self._acting_for
        self._held = self._stop = None
        self._runner.resume()
        self._wake.set()

    def stop(self, reason: str = "") -> None:
        """Hold the queue, also what is just being started. The caller stops the runner. Never waits, takes no lock."""
        self._stop = self._held = reason or STOPPED
        self._wake.set()

    def _run(self) -> None:
        while not self._closed:
            wait_s: float | None = None
            try:
                wait_s = self._step()
            except StoreError as error:
                self._hold(f"the queue cannot be kept: {error}")
            except Exception as error:  # a fault of the software must not go on moving the joint
                self._hold(f"the queue failed: {type(error).__name__}: {error}")
            if wait_s != 0.0:
                self._wake.wait(wait_s)
            self._wake.clear()

    def _step(self) -> float | None:
        """What is to be done now; how long to wait then [s]; None: until something changes."""
        if self._held != self._kept:
            held = self._held
            self.table.settle()  # what could not be said while the store failed
            self.table.hold(held)
            self._kept = held
        if self._held is not None:
            self._hung = None  # somebody may have touched the arm
            return None
        item = self.table.next()
        if item is None:
            return None
        if self._held is not None:
            return 0.0  # since it was looked for: what is added after a pause stays
        if not self._runner.wait(0.0) or self._is_run_elsewhere():
            self._hung = None
            return BUSY_S
        return self._carry_out(item)

    def _is_run_elsewhere(self) -> bool:
        """Another process runs an item of this queue, or ended while it did so."""
        left, others = self.table.settle()
        if left:
            self._hold(LEFT.format(left[0]))
        self.elsewhere = ELSEWHERE.format(others[0]) if others else ""
        return bool(left or others)

    def _carry_out(self, item: QueueItem) -> float:
        self.running = item  # before it waits no longer: at no moment does it seem that there is nothing to do
        try:
            if not self._begin(item):
                return BUSY_S
            experiment_id = self._start(item)
            if experiment_id is None:
                return BUSY_S
            self._follow(item, experiment_id)
        finally:
            self.running = None
        return 0.0

    def _begin(self, item: QueueItem) -> bool:
        """It waits no longer. False where it is not to be started: the laboratory has it back, or gets it.

        Or another process was faster, and runs one.
        """
        if item.lab_claim is None:
            return self.table.begin(item.id)
        confirmed = self.confirm(item.lab_claim)
        try:
            if not confirmed:
                self.table.remove(item.id)
            elif self._held is None:  # else it is held since the laboratory was asked
                return self.table.begin(item.id)
        except (NotFoundError, StoreStateError):
            pass  # it was given back meanwhile
        return False

    def _start(self, item: QueueItem) -> int | None:
        """The experiment; None where there is none."""
        pace = cast(Pace | None, item.pace)
        try:
            with self._starting(self._acting_for if item.lab_claim is None else LABORATORY):
                return self._runner.start(item.kind, item.parameters, item.operator, item.note, pace, self._hung)
        except (BusyError, LeaseHeldError) as error:
            self.table.give_back(item.id)
            if isinstance(error, LeaseHeldError) and item.lab_claim is None:
                self._hold(str(error))
        except (BenchError, DriveError) as error:
            status = self._runner.status()
            self.table.finish(item.id, status.outcome if status.outcome != "running" else "failed", str(error))
            self._hold(f"item {item.id} ({item.kind}) was not started: {error}")
        return None

    def _follow(self, item: QueueItem, experiment_id: int) -> None:
        """To the end of its experiment, whatever that is."""
        if self._stop is not None or self._closed:
            self._runner.stop(self._stop or "the bench was closed")
        elif self._held is not None:
            self._runner.pause()
        try:
            self.table.began(item.id, experiment_id)
            self._store.annotate(experiment_id, tags=item.tags)
        finally:
            self._runner.wait()
            found = self._store.experiment(experiment_id)
            self.table.finish(item.id, found.outcome, found.reason)
            if found.outcome == "completed":
                self._hung = (float(item.loads[-1][0]), bool(item.loads[-1][1])) if item.loads else None
            else:
                why = f": {found.reason}" if found.reason else ""
                self._hold(f"item {item.id} ({item.kind}, experiment {experiment_id}) is {found.outcome}{why}")

    def _hold(self, reason: str) -> None:
        """Unless it is held already: the first reason is the one that is kept."""
        if self._held is None:
            self._held = reason
        self._wake.set()
