"""Opening a CAN bus of python-can, sending on it and closing it in bounded time."""

import errno
import os
import select
import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from time import monotonic
from typing import TypeVar

import can
from can.exceptions import error_check
from can.interfaces.slcan import slcanBus

from drivers.can_bus.settings import BusSettings
from drivers.errors import DriveConnectionError

_WRITE_S = 0.1
_FRAMES = b"tTrRdDbB"  # first letters of lines that are frames; the others answer commands
T = TypeVar("T")
_OPEN_S = 3.0
_CLOSE_S = 1.0
_KNOCK_S = 2.0
_SEND_S = 0.02  # longest wait for room in the transmit buffer
_RETRY_S = 0.0005

_NEXT_STEP = {
    "socketcan": "is the interface there and up? `ip link set {channel} up type can bitrate {bitrate}`",
    "slcan": "is the adapter plugged in, the port right and nobody else using it?",
    "socketcand": "does socketcand run at {host}:{port}, and does it offer {channel}?",
    "virtual": "it exists inside one process only",
}
_WITHOUT_DRIVER = (
    ImportError,
    NameError,
    AttributeError,
)  # what interfaces raise where the vendor's library is missing
_ANY_STEP = "is the adapter plugged in, its driver installed, and `channel` as python-can's documentation has it?"


class SlcanBus(slcanBus):
    """python-can's adapter with its two slow places replaced (4.6.1).

    It reads one byte per system call, and waits for a millisecond even when told not to wait; it writes with a wait
    for the line to drain, which has no time limit.
    """

    def _write(self, string: str) -> None:
        port, data = self.serialPortOrig.fileno(), string.encode() + self.LINE_TERMINATOR
        with error_check():
            while True:
                with suppress(BlockingIOError):
                    data = data[os.write(port, data) :]
                if not data:
                    return
                if not select.select([], [port], [], _WRITE_S)[1]:
                    raise TimeoutError(f"the serial adapter has taken no bytes for {_WRITE_S:g} s")

    def _read(self, timeout: float | None) -> str | None:
        """The next line that is a frame; None where none comes in time [s]."""
        port = self.serialPortOrig
        deadline_s = monotonic() + (timeout or 0.0)
        with error_check("Could not read from serial device"):
            while True:
                line = self._next_frame()
                if line is not None:
                    return line
                if not port.in_waiting:
                    remaining_s = deadline_s - monotonic()
                    if remaining_s <= 0.0:
                        return None
                    if not select.select([port.fileno()], [], [], remaining_s)[0]:
                        continue
                # a port that is ready and has nothing is gone: reading says so
                self._buffer += port.read(max(port.in_waiting, 1)).replace(self._ERROR, self._OK)

    def _next_frame(self) -> str | None:
        while True:
            line, end, rest = self._buffer.partition(self._OK)
            if not end:
                return None
            self._buffer = rest
            if line[:1] and line[:1] in _FRAMES:
                return line.decode("ascii", errors="replace")

    def shutdown(self) -> None:
        """Close the channel and the port."""
        try:
            super().shutdown()
        finally:
            # the port may be gone, and the farewell fails: give the file back all the same
            self.serialPortOrig.close()


def bounded(call: Callable[[], T], timeout_s: float, undo: Callable[[T], object] = lambda _result: None) -> T:
    """Call in a thread of its own, and wait for it no longer than a time.

    Args:
        call: may hang; its exception is raised here.
        timeout_s: how long to wait [s].
        undo: is given a result that came too late.

    Raises:
        TimeoutError: it has not returned in time.
    """
    lock = threading.Lock()
    results: list[T] = []
    errors: list[BaseException] = []
    abandoned = threading.Event()

    def run() -> None:
        try:
            result = call()
        except BaseException as error:
            errors.append(error)
            return
        with lock:
            results.append(result)
            late = abandoned.is_set()
        if late:
            with suppress(Exception):
                undo(result)

    thread = threading.Thread(target=run, name="bounded call", daemon=True)
    thread.start()
    thread.join(timeout_s)
    with lock:
        if not results and not errors:
            abandoned.set()
            raise TimeoutError(f"not done within {timeout_s:g} s")
    if errors:
        raise errors[0]
    return results[0]


def open_bus(settings: BusSettings, device: str) -> can.BusABC:
    """Open a bus.

    Raises:
        DriveConnectionError: it is not there, or does not open in time.
    """
    arguments = settings.arguments()
    timeout_s = _OPEN_S + settings.adapter_start_s
    try:
        if settings.interface == "socketcand":
            # python-can would knock ten seconds long, without a pause
            socket.create_connection((settings.host, settings.port), timeout=_KNOCK_S).close()
        if settings.interface != "slcan":
            return bounded(lambda: can.Bus(**arguments), timeout_s, undo=lambda bus: bus.shutdown())
        del arguments["interface"], arguments["ignore_config"]
        return bounded(lambda: SlcanBus(**arguments), timeout_s, undo=lambda bus: bus.shutdown())
    except (can.CanError, OSError, ValueError, TypeError, *_WITHOUT_DRIVER) as error:
        step = _NEXT_STEP.get(settings.interface, _ANY_STEP).format(
            channel=settings.channel,
            bitrate=settings.bitrate,
            host=settings.host,
            port=settings.port,
        )
        raise DriveConnectionError(
            device, f"the bus {settings.interface} {settings} does not open: {error}; {step}"
        ) from error


def send(bus: can.BusABC, message: can.Message) -> None:
    """Send a frame, and wait for room in the transmit buffer where there is none.

    Raises:
        CanError, OSError: there is no room in time (`is_full`), or the bus cannot be sent on.
    """
    end_s = 0.0  # a clock is asked only where there was no room
    while True:
        try:
            bus.send(message, _SEND_S)
            return
        except (can.CanError, OSError) as error:
            end_s = end_s or time.perf_counter() + _SEND_S
            if not is_full(error) or time.perf_counter() > end_s:
                raise
            time.sleep(_RETRY_S)


def is_full(error: Exception) -> bool:
    """Whether nothing was sent for want of room: SocketCAN tells it by a number, other interfaces by words."""
    code = getattr(error, "error_code", None) or getattr(error, "errno", None)
    return code in (errno.ENOBUFS, errno.EAGAIN) or "buffer full" in str(error).lower()


def close_bus(bus: can.BusABC) -> None:
    """Close a bus, also one that is broken. Never raises, never hangs."""
    with suppress(Exception):
        bounded(bus.shutdown, _CLOSE_S)
