"""Writes down who did what. Requests only hand a line over: the database is a thread's, and STOP waits for none."""

import logging
import queue
import threading
from collections.abc import Callable, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from bench.runs import event_log
from bench.service.auth.attempts import Attempts
from bench.service.auth.tokens import Caller
from bench.service.http.guard import SAFE_METHODS
from bench.store.errors import StoreError
from bench.store.tables.audit import AuditEntry

MOST_WAITING = 10_000  # entries that are kept while the database takes none; the newest are dropped then
RETRY_S = 1.0
LONGEST = 500  # characters of a path or a detail
END_S = 3.0  # what the writer is given at the end
_log = logging.getLogger(__name__)


def note(request: Request, detail: str) -> None:
    """Say what the request changed, in words without secrets; the audit log shows it."""
    request.state.audit_detail = detail


def leave_out(request: Request) -> None:
    """Nothing was changed that somebody might ask for (a heartbeat)."""
    request.state.audit_left_out = True


class AuditWriter:
    """A thread that hands entries to the store, and tries again where it takes none.

    Args:
        write: keeps entries; raises `StoreError` where that is not possible now.
    """

    def __init__(self, write: Callable[[Sequence[AuditEntry]], None]) -> None:
        self._write = write
        self._waiting: queue.Queue[AuditEntry | None] = queue.Queue(MOST_WAITING)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="audit", daemon=True)

    def start(self) -> None:
        """Begin to write."""
        self._thread.start()

    def add(self, entry: AuditEntry) -> None:
        """Never waits."""
        try:
            self._waiting.put_nowait(entry)
        except queue.Full:
            _log.error("audit entry lost, the store takes none: %s", entry)

    def close(self) -> None:
        """Write what waits; give up after a few seconds."""
        self._ending.set()
        try:
            self._waiting.put_nowait(None)
        except queue.Full:
            return
        self._thread.join(END_S)

    def _run(self) -> None:
        while (first := self._waiting.get()) is not None:
            entries = [first]
            while not self._waiting.empty() and (entry := self._waiting.get()) is not None:
                entries.append(entry)
            self._keep(entries)
            if self._ending.is_set() and self._waiting.empty():
                return

    def _keep(self, entries: list[AuditEntry]) -> None:
        while True:
            try:
                self._write(entries)
                return
            except StoreError as error:
                _log.warning("the audit log cannot be written: %s", error)
                if self._ending.wait(RETRY_S):
                    _log.error("audit entries lost: %s", entries)
                    return


class AuditTrail:
    """ASGI middleware: an entry for each request that may change something, answered or refused.

    Of requests without a token, of which none changes anything, an address has the first few noted, and then one every
    few seconds: the store would grow by them.
    """

    def __init__(self, app: ASGIApp, add: Callable[[AuditEntry], None], strangers: Attempts) -> None:
        self._app = app
        self._add = add
        self._strangers = strangers

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and note what was answered."""
        if scope["type"] != "http" or scope["method"] in SAFE_METHODS:
            await self._app(scope, receive, send)
            return
        status = 500

        async def watching(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        scope.setdefault("state", {})
        try:
            await self._app(scope, receive, watching)
        finally:
            # too many wrong tokens: those before are noted
            if status != 429 and not scope["state"].get("audit_left_out") and self._is_noted(scope):
                entry = _entry(scope, status)
                self._add(entry)
                event_log.note("request", _level(status), **_facts(entry))

    def _is_noted(self, scope: Scope) -> bool:
        if scope["state"].get("caller") is not None:
            return True
        address = _address(scope)
        if self._strangers.wait_s(address):
            return False
        self._strangers.failed(address)
        return True


def _address(scope: Scope) -> str:
    client = scope.get("client")
    return client[0] if client else ""


def _entry(scope: Scope, status: int) -> AuditEntry:
    state: dict[str, Any] = scope["state"]
    caller: Caller | None = state.get("caller")
    return AuditEntry(
        at_utc=datetime.now(UTC),
        token=caller.name if caller else "",
        role=str(caller.role) if caller else "",
        client=_address(scope),
        method=scope["method"],
        path=_plain(scope["path"]),
        status=status,
        detail=_plain(state.get("audit_detail", "")),
    )


def _facts(entry: AuditEntry) -> dict[str, object]:
    """As the log has it, which stamps its lines itself."""
    return {name: value for name, value in asdict(entry).items() if name != "at_utc"}


def _level(status: int) -> int:
    return logging.ERROR if status >= 500 else logging.WARNING if status in (401, 403) else logging.INFO


def _plain(text: str) -> str:
    """Printable and short: it comes from outside, and is shown on terminals."""
    return "".join(sign if sign.isprintable() else "?" for sign in text)[:LONGEST]
