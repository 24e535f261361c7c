"""One bench process, seen from the service that started it."""

import signal
import socket
import subprocess
import sys
import threading
from multiprocessing.connection import Connection

from bench.runs.bench_process.errors import BenchProcessError, NotBegunError
from bench.runs.bench_process.messages import VERSION, Close, Hello

MODULE = "bench.runs.bench_process.process"
REAP_S = 5.0  # how long a process that has hung up is waited for


class Child:
    """A process that was started, and the connection to it.

    Its session is its own: Ctrl-C at the terminal is for the service, which stops the joint and then closes this.

    Raises:
        OSError: the machine starts no more processes.
    """

    def __init__(self, stop_file: int, hello: Hello, module: str = MODULE) -> None:
        ours, theirs = socket.socketpair()
        with theirs:
            # the same path as here: a folder called `bench` in the working directory is not meant
            program = f"import sys; sys.path[:] = {sys.path!r}; from {module} import main; main()"
            words = [sys.executable, "-c", program, str(theirs.fileno()), str(stop_file)]
            try:
                self._process = subprocess.Popen(  # noqa: S603
                    words, stdin=subprocess.DEVNULL, pass_fds=(theirs.fileno(), stop_file), start_new_session=True
                )
            except BaseException:
                ours.close()
                raise
        self._connection = Connection(ours.detach())
        self._sending = threading.Lock()
        try:
            self._send(VERSION, hello)
        except BenchProcessError:
            self.reap()  # nobody else will: there is no child to be asked
            raise

    @property
    def process_id(self) -> int:
        """Of the operating system."""
        return self._process.pid

    def send(self, message: object) -> None:
        """Send a message.

        Raises:
            NotBegunError: the process has ended.
        """
        self._send(message)

    def check_version(self) -> None:
        """Wait until it has started.

        Raises:
            BenchProcessError: it is of another version.
            EOFError, OSError: it has ended.
        """
        found = self._connection.recv_bytes()
        if found != VERSION:
            raise BenchProcessError(
                f"the bench process says '{found.decode(errors='replace')}', this service '{VERSION.decode()}': "
                "the software was updated under a running service; end the service and start it again"
            )

    def receive(self) -> object:
        """The next message.

        Raises:
            EOFError, OSError: the process has ended.
        """
        return self._connection.recv()

    def close(self) -> None:
        """Ask it to stop the joint and end."""
        try:
            self._send(Close())
        except BenchProcessError:
            return

    def kill(self) -> None:
        """End it at once; the drive is left to its watchdog."""
        self._process.kill()

    def reap(self) -> str:
        """Hang up, wait for its end, and say how it ended; killed where it goes on."""
        self._connection.close()
        try:
            code = self._process.wait(REAP_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            code = self._process.wait()
        return f"ended with code {code}" if code >= 0 else f"was ended by {_signal_name(-code)}"

    def _send(self, *messages: object) -> None:
        try:
            with self._sending:
                for message in messages:
                    if isinstance(message, bytes):
                        self._connection.send_bytes(message)
                    else:
                        self._connection.send(message)
        except (OSError, ValueError) as error:
            raise NotBegunError("the bench process has ended; the next start starts it again") from error


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
