"""The bench process: it owns the drive, the control loop and the recorder, and takes its orders from a service.

It ends when the service closes it, when the service is gone, or on SIGTERM; each time the joint is braked and powered
off first, and the record is closed.
"""

import os
import queue
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from multiprocessing.connection import Connection

from bench.config.configuration import BenchConfiguration
from bench.control import scheduling
from bench.control.drive_factory import make_equipment
from bench.errors import BenchError
from bench.runs import event_log
from bench.runs.bench_process.messages import SLOW, VERSION, Accepted, Call, Hello, Method, Reply, Seen, failure_of
from bench.runs.bench_process.stop_line import LineStop, StopLine
from bench.runs.runner import HostProcess, Runner
from bench.store import Store

PERIOD_S = 0.02  # shorter than a block of the recorder: each is told by itself
MOST_ROWS = 20_000
GONE = (OSError, ValueError)  # the service has closed its end; ValueError: this end is closed
ORPHAN = "the service that ran the bench is gone (killed, or it crashed)"
TERMINATED = "the bench process was ended by a signal"
LOOK_S = 0.5  # how often to see whether the parent is still there: something of its could hold the connection open
LAST_S = 90.0  # a drive that does not let go by then is left to its watchdog


class Publisher:
    """All that is sent to the service: messages go out whole, and what was seen later goes out later.

    Where the service does not read, this waits, and nothing else does.
    """

    def __init__(self, runner: Runner, connection: "Connection") -> None:
        self._runner = runner
        self._connection = connection
        self._sending = threading.Lock()
        self._woken = threading.Event()
        self._calls = 0  # under way
        self._last_row = -1
        self._told: object = None
        threading.Thread(target=self._run, name="publisher", daemon=True).start()

    def begin_call(self, number: int) -> None:
        """Say that a call has come: something is about to change."""
        self.tell(Accepted(number))
        self._calls += 1
        self._woken.set()

    def end_call(self, reply: object) -> None:
        """Send what has changed, then what came of the call."""
        self.tell(reply)
        self._calls -= 1
        self._woken.set()

    def tell(self, message: object = None) -> None:
        """Send what has happened since the last time, then a message."""
        with self._sending:
            try:
                self._tell_news()
                if message is not None:
                    self._connection.send(message)
            except GONE:
                pass  # whoever receives hears of it, too

    def _run(self) -> None:
        while True:
            if self._runner.wait(PERIOD_S):  # returns as soon as nothing runs
                self.tell()
                self._woken.wait(PERIOD_S if self._calls else None)
                self._woken.clear()
            self.tell()

    def _tell_news(self) -> None:
        status, busy = self._runner.status(), not self._runner.wait(0.0)
        rows = self._runner.live(self._last_row, MOST_ROWS)
        # a new reading alone is no news: it comes with its row
        news = (replace(status, reading=None, progress=0.0), busy, rows.last_row)
        if news == self._told:
            return
        self._connection.send(Seen(status, busy, rows))
        self._told, self._last_row = news, rows.last_row


class BenchProcess:
    """What runs here."""

    def __init__(
        self, connection: "Connection", line: StopLine, configuration: BenchConfiguration, store: Store
    ) -> None:
        self._connection = connection
        self._store = store
        self._before = line.asked()
        facts = {"control_loop": {"process": "its own", "scheduling": scheduling.describe()}}
        host = HostProcess(lambda: LineStop(line, self._before), scheduling.undisturbed, facts)
        runner = self._runner = Runner(configuration, store, host)
        self._methods: dict[Method, Callable[..., object]] = {
            "begin": runner.begin,
            "answer": runner.answer,
            "pause": runner.pause,
            "resume": runner.resume,
            "look": runner.look,
            "read_drives": runner.read_drives,
            "clear_faults": runner.clear_faults,
        }
        self._publisher = Publisher(self._runner, connection)
        self._slow_calls: queue.Queue[Call] = queue.Queue()
        self._parent = os.getppid()
        self.ended = ""  # why, once it has to end
        threading.Thread(target=self._make_slow_calls, name="calls", daemon=True).start()

    def serve(self) -> None:
        """Until the service closes it or is gone, or a signal has come; the joint is off then."""
        while not self.ended:
            message = self._receive()
            if isinstance(message, Call) and not self.ended:
                self._publisher.begin_call(message.number)
                self._slow_calls.put(message) if message.method in SLOW else self._make(message)
        last = threading.Timer(LAST_S, os._exit, (1,))
        last.daemon = True
        last.start()
        self._runner.stop(self.ended)
        self._runner.close()
        self._publisher.tell()

    def end(self, _number: int, _frame: object) -> None:
        """Signal handler: stop the joint now, and end."""
        self.ended = TERMINATED
        self._runner.stop(TERMINATED)

    def _receive(self) -> object:
        """The next message; None where none has come for a while, or none will come any more."""
        try:
            if self._connection.poll(LOOK_S):
                message = self._connection.recv()
                if not isinstance(message, Call):
                    self.ended = "the bench was closed"
                return message
            if os.getppid() != self._parent:
                self.ended = ORPHAN
        except (EOFError, OSError):
            self.ended = self.ended or ORPHAN
        return None

    def _make_slow_calls(self) -> None:
        while True:
            try:
                call = self._slow_calls.get(timeout=LOOK_S)
            except queue.Empty:
                if self._runner.wait(0.0):
                    self._store.custody.write_noted()  # of a run that ended on a full or locked database
                continue
            self._before = call.stops
            self._make(call)

    def _make(self, call: Call) -> None:
        try:
            reply: object = Reply(call.number, self._methods[call.method](*call.arguments))
        except BaseException as error:
            reply = failure_of(call.number, error)
        self._publisher.end_call(reply)


def main() -> None:
    """Serve the service that started this process; it has passed two descriptors: of the connection, of the line."""
    connection, line = Connection(int(sys.argv[1])), StopLine(int(sys.argv[2]))
    with suppress(EOFError, *GONE):
        connection.send_bytes(VERSION)
        if connection.recv_bytes() != VERSION:
            return  # the service sees by ours that we do not understand each other
        hello = connection.recv()
        if isinstance(hello, Hello):
            event_log.begin_as_chosen()
            _run(connection, line, hello.configuration)


def _run(connection: "Connection", line: StopLine, configuration: BenchConfiguration) -> None:
    try:
        store = Store.open(configuration.store.url)
    except BenchError as error:
        connection.send(failure_of(0, error))
        return
    with store:
        bench = BenchProcess(connection, line, configuration, store)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            signal.signal(number, bench.end)
        _warm_up(configuration)
        bench.serve()


def _warm_up(configuration: BenchConfiguration) -> None:
    """Import, and where need be compile, what the drive needs: the first experiment does not wait for it."""
    with suppress(BenchError):  # it is said when an experiment is started
        make_equipment(configuration)
    scheduling.prepare()
