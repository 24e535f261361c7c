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
from multiprocessing.connection import Connection

from bench.config.configuration import BenchConfiguration
from bench.control import scheduling
from bench.control.drive_factory import make_equipment
from bench.errors import BenchError
from bench.runs import event_log
from bench.runs.bench_process.messages import SLOW, VERSION, Call, Hello, Method, Reply, failure_of
from bench.runs.bench_process.publisher import GONE, Publisher
from bench.runs.bench_process.stop_line import LineStop, StopLine
from bench.runs.runner import HostProcess, Runner
from bench.store import Store

ORPHAN = "the service that ran the bench is gone (killed, or it crashed)"
TERMINATED = "the bench process was ended by a signal"
LOOK_S = 0.5  # how often to see whether the parent is still there: something of its could hold the connection open
LAST_S = 90.0  # a drive that does not let go by then is left to its watchdog


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
