"""Starts the bench process when it is wanted, takes in what it says, and sees how it ends."""

import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from typing import Any

from bench.config.channels import RECORDED
from bench.config.sections import Limits
from bench.errors import BusyError
from bench.runs import event_log
from bench.runs.bench_control import RunnerStatus
from bench.runs.bench_process.child import Child
from bench.runs.bench_process.errors import BenchProcessError, NotBegunError
from bench.runs.bench_process.messages import Accepted, Failure, Reply, Seen, error_of
from bench.runs.live import LiveBuffer
from drivers.contract import Description

HANGING_UP_S = 5.0  # from the first message that fails until its end is seen, on the busiest machine
CLOSING_S = 100.0  # a process that has not ended by then is killed


class Calls:
    """Each has a number, and a future for what comes of it. Any thread may use it."""

    def __init__(self) -> None:
        self._open: dict[int, Future[Any]] = {}
        self._accepted: set[int] = set()
        self._number = 0
        self._lock = threading.Lock()

    def open(self) -> tuple[int, Future[Any]]:
        """A new call."""
        with self._lock:
            self._number += 1
            found = self._open[self._number] = Future()
            return self._number, found

    def accept(self, number: int) -> None:
        """One has been begun."""
        with self._lock:
            self._accepted.add(number)

    def close(self, reply: Reply | Failure) -> None:
        """What came of one."""
        found = self._pop(reply.number)
        if found is None:
            return
        if isinstance(reply, Failure):
            found.set_exception(error_of(reply))
        else:
            found.set_result(reply.value)

    def forget(self, number: int) -> None:
        """Nobody waits for it any more."""
        self._pop(number)

    def fail(self, said: BaseException | None, reason: str) -> None:
        """No more replies will come: the process has ended."""
        with self._lock:
            left, accepted = dict(self._open), set(self._accepted)
        for number in left:
            if (found := self._pop(number)) is not None:
                kind = BenchProcessError if number in accepted else NotBegunError
                found.set_exception(said or kind(reason))

    def _pop(self, number: int) -> "Future[Any] | None":
        with self._lock:
            self._accepted.discard(number)
            return self._open.pop(number, None)


class Mirror:
    """Status and live rows, at most a publisher's period old."""

    def __init__(self, limits: Limits) -> None:
        self.status = RunnerStatus(None, "", "", "", 0, 0, 0.0, None, None, limits)
        self.live = LiveBuffer(RECORDED)
        self._busy = False
        self._new_process = True
        self._changed = threading.Condition()

    def take_in(self, seen: Seen) -> None:
        """The news."""
        if seen.rows.restarted or (self._new_process and len(seen.rows.rows)):
            self._new_process = False
            rows = seen.rows
            self.live.begin_trial(rows.channels, rows.trial_id, rows.trial_rows - len(rows.rows))
        if len(seen.rows.rows):
            self.live.append(seen.rows.rows)
        self._change(seen.status, seen.busy)

    def lose(self, reason: str) -> bool:
        """The process has ended; True where that has interrupted an experiment. Nothing is free before `release`."""
        running = self.status.outcome == "running"
        self._new_process = True
        ended = replace(self.status, outcome="interrupted", reason=reason, prompt=None) if running else self.status
        self._change(ended, busy=self._busy)
        return running

    def release(self) -> None:
        """Its records are in order: who waited may go on."""
        self._change(self.status, busy=False)

    def wait(self, timeout_s: float | None) -> bool:
        """Wait until nothing runs; False where that takes longer than `timeout_s`."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._busy, timeout_s)

    def _change(self, status: RunnerStatus, busy: bool) -> None:
        with self._changed:
            self.status, self._busy = status, busy
            self._changed.notify_all()


class Supervisor:
    """One thread, and one process at a time. The first is started at once.

    Args:
        launch: starts a process.
        mirror: told what it says.
        calls: told its replies.
        lost: called with the reason when an experiment was interrupted, after the process has ended.
    """

    def __init__(self, launch: Callable[[], Child], mirror: Mirror, calls: Calls, lost: Callable[[str], None]) -> None:
        self._launch = launch
        self._mirror = mirror
        self._calls = calls
        self._lost = lost
        self._child: Child | None = None
        self._wanted = True
        self._closed = False
        self._failure: OSError | None = None  # of the last launch
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, name="supervisor of the bench process", daemon=True)
        self._thread.start()

    def child(self) -> Child:
        """The process; started where there is none.

        Raises:
            BusyError: closed.
            BenchProcessError: it does not start.
        """
        with self._changed:
            if self._child is None:
                self._wanted, self._failure = True, None
                self._changed.notify_all()
            self._changed.wait_for(lambda: self._child or self._failure or self._closed)
            if self._closed:
                raise BusyError("the bench is closed; nothing can be started")
            if self._child is None:
                raise BenchProcessError(f"the bench process cannot be started: {self._failure}")
            return self._child

    def wait_for_end_of(self, child: Child) -> None:
        """Until it is seen that a process has hung up: before that, what it is sent fails, and `child` is still it."""
        with self._changed:
            self._changed.wait_for(lambda: self._child is not child, HANGING_UP_S)

    def close(self) -> None:
        """End the process, and wait for its end. Safe to call twice."""
        with self._changed:
            self._closed, child = True, self._child
            self._changed.notify_all()
        if child is not None:
            child.close()
        self._thread.join(CLOSING_S)
        if self._thread.is_alive() and child is not None:
            child.kill()
            self._thread.join()

    def _run(self) -> None:
        while self._is_wanted():
            try:
                child = self._launch()
            except OSError as error:
                self._change(None, error)
                continue
            self._change(child)
            ending = self._listen(child)
            self._change(None)
            self._end(child, ending)

    def _is_wanted(self) -> bool:
        """Wait until a process is wanted; False: none any more."""
        with self._changed:
            self._changed.wait_for(lambda: self._wanted or self._closed)
            self._wanted = False
            return not self._closed

    def _change(self, child: Child | None, failure: OSError | None = None) -> None:
        with self._changed:
            self._child, self._failure = child, failure
            closed = self._closed
            self._changed.notify_all()
        if closed and child is not None:
            child.close()  # it was being started meanwhile

    def _listen(self, child: Child) -> BaseException | None:
        """Until the process hangs up. Returns what it said of that, if anything."""
        try:
            child.check_version()
            while True:
                message = child.receive()
                if isinstance(message, Failure) and message.number == 0:
                    return error_of(message)
                self._take_in(message)
        except BenchProcessError as error:
            return error
        except (EOFError, OSError):
            return None

    def _take_in(self, message: object) -> None:
        if isinstance(message, Seen):
            self._mirror.take_in(message)
        elif isinstance(message, Accepted):
            self._calls.accept(message.number)
        elif isinstance(message, Reply | Failure):
            self._calls.close(message)

    def _end(self, child: Child, said: BaseException | None) -> None:
        how = child.reap()
        reason = f"the bench process {how} while it ran; {_what_stops(self._mirror.status.description)}"
        was_running = self._mirror.lose(reason)
        level = logging.ERROR if was_running else logging.INFO if self._closed else logging.WARNING
        event_log.note("bench process ended", level, how=how, while_running=was_running)
        if was_running:
            self._lost(reason)
        self._mirror.release()
        self._calls.fail(said, f"the bench process {how}; the next start starts it again")


def _what_stops(found: Description | None) -> str:
    """What stops the motor of a drive whose host is gone."""
    if found is None:
        return "the drive's own watchdog stops the motor"
    if found.watchdog_s is None:
        return "NOTHING STOPS THE MOTOR, for the drive has no watchdog: switch its supply off"
    return f"the drive's own watchdog stops the motor within {found.watchdog_s:g} s"
