"""A connection: how long it may say nothing, and how long it may read nothing; every one that is open takes a file.

An operating system gives a process so many files. Where connections that ask nothing had taken all of them, STOP could
not come in. uvicorn bounds the pause after an answer, and nothing else.
"""

import asyncio
import resource
from contextlib import suppress

from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD_S = 10.0  # until the head of a request is here, from when the connection was open or its first byte came
UNREAD_S = 60.0  # that an answer may wait for whoever asked to read on
MOST_SILENT = 1024  # connections without a request; of more, the one that has been silent longest is closed
OTHER_FILES = 200  # of the process: those of the store, the log, the bench process; and what comes beside a connection
_OF_FILES = 0.5  # share of what the process may open that connections have at least


class Connection(H11Protocol):
    """uvicorn's, ended when it is silent for too long, or where there are too many: STOP comes as one more."""

    _open: dict["Connection", None] = {}  # noqa: RUF012  of the process; the one whose request came longest ago first
    _silent: dict["Connection", asyncio.TimerHandle] = {}  # noqa: RUF012  of these, oldest first
    _unread: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for a request."""
        super().connection_made(transport)
        self._open[self] = None
        if len(self._open) > most_open():
            next(iter(self._silent or self._open))._end()
        self._look()

    def data_received(self, data: bytes) -> None:
        """Wait on, or for no longer."""
        super().data_received(data)
        if self in self._open:  # to the end: it has asked last
            self._open[self] = self._open.pop(self)
        self._look()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no longer."""
        self._open.pop(self, None)
        self._forget()
        self._read_on()
        super().connection_lost(exc)

    def pause_writing(self) -> None:
        """Wait for whoever asked to read."""
        super().pause_writing()
        self._unread = self.loop.call_later(UNREAD_S, self.transport.abort)

    def resume_writing(self) -> None:
        """They have read."""
        super().resume_writing()
        self._read_on()

    def _look(self) -> None:
        """A request that is under way, or has just been answered, is not waited for."""
        if self.cycle is not None and not self.cycle.response_complete:
            self._forget()
        elif self not in self._silent and self.timeout_keep_alive_task is None and not self.transport.is_closing():
            self._silent[self] = self.loop.call_later(HEAD_S, self._end)
            if len(self._silent) > most_silent():
                next(iter(self._silent))._end()

    def _end(self) -> None:
        self._open.pop(self, None)
        self._forget()
        self.transport.abort()

    def _forget(self) -> None:
        if (timer := self._silent.pop(self, None)) is not None:
            timer.cancel()

    def _read_on(self) -> None:
        if self._unread is not None:
            self._unread.cancel()
            self._unread = None


def most_silent() -> int:
    """How many connections may be without a request."""
    return min(MOST_SILENT, int(_OF_FILES * _files()))


def most_open() -> int:
    """How many connections may be open."""
    return max(_files() - OTHER_FILES, int(_OF_FILES * _files()))


def _files() -> int:
    return resource.getrlimit(resource.RLIMIT_NOFILE)[0]


def allow_files() -> None:
    """Let this process open as many files as it may."""
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with suppress(ValueError, OSError):  # a system may allow less than it says
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
