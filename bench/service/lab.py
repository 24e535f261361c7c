"""The model lab of a service: functions of `bench.study`, called in this process or in processes of their own.

A fit takes a processor for as long as it lasts, and within one process the interpreter, too. In a process of its own,
behind all other programs, it takes what they leave: the control loop, STOP and the readers come first.
"""

import os
import resource
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar

from bench.errors import BenchError
from bench.runs.bench_process.messages import Failure, error_of, failure_of
from bench.store import Store
from compensator.lab.progress import Stage, followed

P = ParamSpec("P")
T = TypeVar("T")
NICENESS = 10  # -20 .. 19: more is less of the processor
FIRST_TO_GO = "1000"  # where the machine runs out of memory: the kernel then ends no control loop
MOST_OF_MEMORY = 0.4  # share of the machine's that a process may have: two compute at once


class LabEndedError(BenchError, ConnectionError):
    """Raised when the process that computed was killed, or ran out of memory."""


class Asker:
    """Whoever asked for a call. Once they have given it up, its process ends: nobody waits for the answer."""

    def __init__(self, told: Callable[[Stage], None] = lambda _: None) -> None:
        self.told = told
        self.has_given_up = False
        self._lock = threading.Lock()
        self._end: Callable[[], None] | None = None

    def give_up(self) -> None:
        """End what is computed, or keep it from beginning. From any thread."""
        with self._lock:
            self.has_given_up = True
            if self._end is not None:
                self._end()

    @contextmanager
    def waiting(self, end: Callable[[], None]) -> Iterator[None]:
        """While it is computed.

        Raises:
            LabEndedError: it has been given up already.
        """
        with self._lock:
            if self.has_given_up:
                raise LabEndedError("whoever asked has gone")
            self._end = end
        try:
            yield
        finally:
            with self._lock:
                self._end = None


class Lab(Protocol):
    """Calls functions that take the store first; each waits for its result."""

    def call_for(
        self, asker: Asker, function: Callable[Concatenate[Store, P], T], /, *args: P.args, **kwargs: P.kwargs
    ) -> T:
        """The function's result, for somebody who may give it up. `args` and `kwargs` are those after the store.

        Raises:
            LabEndedError: they have.
        """

    def close(self) -> None:
        """End whatever is under way."""


class LabHere:
    """In the thread that calls."""

    def __init__(self, store: Store) -> None:
        self._store = store

    def call_for(
        self, asker: Asker, function: Callable[Concatenate[Store, P], T], /, *args: P.args, **kwargs: P.kwargs
    ) -> T:
        """See `Lab`; what has begun in this thread goes on to its end."""
        with asker.waiting(lambda: None), followed(asker.told):
            return function(self._store, *args, **kwargs)

    def close(self) -> None:
        """Nothing to do."""


class LabProcesses:
    """In processes of their own, as many as are called at once; one that has started is used again."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._idle: list[_Worker] = []
        self._all: set[_Worker] = set()
        self._lock = threading.Lock()
        self._closed = False

    def call_for(
        self, asker: Asker, function: Callable[Concatenate[Store, P], T], /, *args: P.args, **kwargs: P.kwargs
    ) -> T:
        """See `Lab`.

        Raises:
            LabEndedError: also where its process ended meanwhile; the next call starts another one.
        """
        worker = self._take()
        try:
            with asker.waiting(worker.end):
                result: T = worker.call(_Call(function, args, kwargs), asker.told)
        except LabEndedError:
            self._drop(worker)
            raise
        except BaseException:
            self._give_back(worker)
            raise
        if asker.has_given_up:  # its process may be ending
            self._drop(worker)
        else:
            self._give_back(worker)
        return result

    def close(self) -> None:
        """End whatever is under way. Safe to call twice."""
        with self._lock:
            self._closed, left = True, list(self._all)
            self._all.clear()
            self._idle.clear()
        for worker in left:
            worker.end()

    def _take(self) -> "_Worker":
        with self._lock:
            if self._closed:
                raise LabEndedError("the service is ending; nothing is computed any more")
            if self._idle:
                return self._idle.pop()
            worker = _Worker(self._url)
            self._all.add(worker)
            return worker

    def _give_back(self, worker: "_Worker") -> None:
        with self._lock:
            if worker in self._all:
                self._idle.append(worker)

    def _drop(self, worker: "_Worker") -> None:
        with self._lock:
            self._all.discard(worker)
        worker.end()


@dataclass(frozen=True, slots=True)
class _Call:
    """What a process is sent: a function of a module, by which pickle finds it there, and its arguments."""

    function: Callable[..., Any]
    args: tuple[Any, ...]
    kwargs: dict[str, Any]


class _Worker:
    """One process, and the way to it. Used by one thread at a time."""

    def __init__(self, url: str) -> None:
        context = get_context("spawn")  # a fork would take the threads' locks with it
        self._connection, theirs = context.Pipe()
        with theirs:
            self._process = context.Process(target=work, args=(theirs, url), name="lab", daemon=True)
            self._process.start()

    def call(self, call: _Call, told: Callable[[Stage], None]) -> Any:
        try:
            self._connection.send(call)
            while isinstance(found := self._connection.recv(), Stage):
                told(found)
        except (EOFError, OSError) as error:
            raise LabEndedError("the process that computed has ended (killed, or out of memory); ask again") from error
        if isinstance(found, Failure):
            raise error_of(found)
        return found

    def end(self) -> None:
        with suppress(OSError):
            self._process.kill()  # a fit that is under way keeps nothing; the database undoes what was being written
        self._process.join()


def work(connection: Connection, url: str) -> None:
    """What such a process does: calls, one after the other, until the service is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # at the terminal: the service ends this
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    limit = int(MOST_OF_MEMORY * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    resource.setrlimit(resource.RLIMIT_DATA, (limit, resource.getrlimit(resource.RLIMIT_DATA)[1]))
    with suppress(OSError):  # Linux alone has it
        Path("/proc/self/oom_score_adj").write_text(FIRST_TO_GO, encoding="ascii")
    with suppress(EOFError, OSError), Store.open(url) as store:
        while True:
            call: _Call = connection.recv()
            try:
                with followed(connection.send):
                    answer = call.function(store, *call.args, **call.kwargs)
            except MemoryError:
                wanted = "it needs more memory than a computation may have here; ask for less, such as fewer trials"
                answer = failure_of(0, LabEndedError(wanted))
            except Exception as error:
                answer = failure_of(0, error)
            connection.send(answer)
