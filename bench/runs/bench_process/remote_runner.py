"""A runner whose control loop is in a process of its own."""

import os
from contextlib import suppress
from typing import Any

from bench.config.configuration import BenchConfiguration
from bench.control.drive_faults import DriveState
from bench.runs.bench_control import BenchControl, Request, RunnerStatus
from bench.runs.bench_process.child import MODULE, Child
from bench.runs.bench_process.errors import BenchProcessError, NotBegunError
from bench.runs.bench_process.messages import Call, Hello, Method
from bench.runs.bench_process.stop_line import StopLine
from bench.runs.bench_process.supervisor import Calls, Mirror, Supervisor
from bench.runs.connection import Connection
from bench.runs.live import LiveRows
from bench.store import Store
from bench.store.errors import StoreError

TRIES = 3  # processes that are asked, where one after the other ends before it has begun


class RemoteRunner(BenchControl):
    """The bench in operation, its control loop in a process of its own.

    The process is started at once, and again by the next start of an experiment after its end.

    Args:
        configuration: of the bench.
        store: this process's own access to it; what a bench process leaves running is marked in it.
        module: what the process runs, see `Child`.
    """

    def __init__(self, configuration: BenchConfiguration, store: Store, module: str = MODULE) -> None:
        self.configuration = configuration
        self._store = store
        self._line, file = StopLine.make()
        self._stop_file: int | None = file
        self._mirror = Mirror(configuration.limits)
        self._calls = Calls()
        hello = Hello(configuration)
        self._supervisor = Supervisor(
            lambda: Child(file, hello, module), self._mirror, self._calls, self._mark_interrupted
        )

    def begin(self, request: Request) -> int:
        """See `BenchControl.start`."""
        experiment_id: int = self._call("begin", request)
        return experiment_id

    def status(self) -> RunnerStatus:
        """See `BenchControl`."""
        return self._mirror.status

    def answer(self, prompt_number: int) -> None:
        """See `BenchControl`."""
        self._call("answer", prompt_number)

    def look(self, bench: BenchConfiguration) -> Connection:
        """See `BenchControl`."""
        found: Connection = self._call("look", bench)
        return found

    def read_drives(self) -> tuple[DriveState, ...]:
        """See `BenchControl`."""
        found: tuple[DriveState, ...] = self._call("read_drives")
        return found

    def clear_faults(self, shown: str) -> tuple[DriveState, ...]:
        """See `BenchControl`."""
        found: tuple[DriveState, ...] = self._call("clear_faults", shown)
        return found

    def live(self, after_row: int = -1, limit: int = 2000) -> LiveRows:
        """See `BenchControl`."""
        return self._mirror.live.since(after_row, limit)

    def stop(self, reason: str = "") -> None:
        """See `BenchControl`; goes past everything that may be on its way to the process."""
        self._line.ask(reason)

    def pause(self) -> None:
        """See `BenchControl`."""
        self._tell_running("pause")

    def resume(self) -> None:
        """See `BenchControl`."""
        self._tell_running("resume")

    def wait(self, timeout_s: float | None = None) -> bool:
        """See `BenchControl`."""
        return self._mirror.wait(timeout_s)

    def close(self) -> None:
        """See `BenchControl`; the process ends."""
        self.stop("the bench was closed")
        self._supervisor.close()
        if self._stop_file is not None:
            os.close(self._stop_file)
            self._stop_file = None

    def _tell_running(self, method: Method) -> None:
        if self.status().outcome == "running":
            with suppress(BenchProcessError):  # what it was meant for has ended with the process
                self._call(method)

    def _call(self, method: Method, *arguments: Any) -> Any:
        stops = self._line.settled()  # what is asked for from here on counts
        for _ in range(TRIES - 1):
            child = self._supervisor.child()
            with suppress(NotBegunError):  # it was just ending: another process is there next time
                return self._call_once(child, method, arguments, stops)
            self._supervisor.wait_for_end_of(child)
        return self._call_once(self._supervisor.child(), method, arguments, stops)

    def _call_once(self, child: Child, method: Method, arguments: tuple[Any, ...], stops: int) -> Any:
        number, answer = self._calls.open()
        try:
            child.send(Call(number, method, arguments, stops))
            return answer.result()
        finally:
            self._calls.forget(number)

    def _mark_interrupted(self, reason: str) -> None:
        with suppress(StoreError):  # a full or locked database: the next bench process does it
            self._store.custody.settle(reason)
