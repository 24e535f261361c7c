"""The stream of /live: what was missed, then status and rows as they come."""

import asyncio
import json
import time
from collections import OrderedDict
from collections.abc import AsyncIterator, Iterator
from dataclasses import replace
from math import inf
from typing import Any, NamedTuple

import anyio.to_thread

from bench.control.drive_factory import is_simulated
from bench.runs.bench_control import BenchControl
from bench.runs.lease import Lease
from bench.runs.live import LiveRows
from bench.service.http.downloads import column
from bench.service.live.replay import CHUNK_ROWS, GapError, Mark, Piece, missed, skipped_experiments
from bench.service.live.status import Rows, Status, rows_of, status_of
from bench.service.routes.leases import lease_now
from bench.store import Store
from bench.store.errors import StoreError

PERIOD_S = 0.025  # shorter than a block of the recorder: each is told by itself
LISTENER_S = 2e-4  # of the event loop, for telling one listener
STATUS_EVERY_S = 0.5  # in between, only what is new is sent
ALL_ROWS = 10**6  # more than the live buffer keeps
FEW_ROWS = 200  # that the event loop writes itself, in a millisecond or two
MOST_WRITTEN = 16  # events of rows that are kept for listeners who are about to hear them


class _Told(NamedTuple):
    """A status as it is told."""

    at_s: float
    key: str
    event: str


class LiveEvents:
    """Makes the events of all listeners. They hear the same: each event is written once, and told to every one of them.

    Used on the event loop alone.

    Args:
        state: of the application; `life` names this process, `ending` ends the stream.
        store: where rows are that are live no more.
        runner: of the bench.
        lease: of the bench.
    """

    def __init__(self, state: Any, store: Store, runner: BenchControl, lease: Lease) -> None:
        self.state, self.store, self.runner, self.lease = state, store, runner, lease
        self._rows: OrderedDict[tuple[object, ...], str] = OrderedDict()
        self._status = _Told(-inf, "", "")
        self._listeners = 0
        self._look: asyncio.Future[None] | None = None

    async def stream(self, after_row: int, limit: int, last_event_id: str | None) -> AsyncIterator[str]:
        """Events as text, until the listener goes or the service ends."""
        if last_event_id is not None:
            now = self.runner.live(-1, 1)
            async for event in self._missed(last_event_id, now):
                yield event
            after_row = now.last_row
        async for event in self._coming(after_row, limit):
            yield event

    async def _coming(self, after_row: int, limit: int) -> AsyncIterator[str]:
        shown, told_s = "", -inf
        self._listeners += 1
        try:
            while not self.state.ending:
                known = self._newest()
                found = self.runner.live(after_row, limit)
                if len(found.rows) or (found.restarted and found.last_row != after_row):
                    after_row = found.last_row
                    yield await self._rows_event(found)
                status = self._status_now()
                if status.key != shown or time.monotonic() - told_s >= STATUS_EVERY_S:
                    shown, told_s = status.key, time.monotonic()
                    yield status.event
                await self._news(known)
        finally:
            self._listeners -= 1

    async def _news(self, known: tuple[int, str]) -> None:
        """Until something is newer than what is known, or a status is due: one look for all listeners together."""
        if self._newest() != known:
            await asyncio.sleep(self._period_s())
            return
        if self._look is None or self._look.done():
            self._look = asyncio.ensure_future(self._look_out(known))
        await asyncio.shield(self._look)

    async def _look_out(self, known: tuple[int, str]) -> None:
        end_s = time.monotonic() + STATUS_EVERY_S
        while not self.state.ending and time.monotonic() < end_s:
            await asyncio.sleep(self._period_s())
            if self._newest() != known:
                return

    def _newest(self) -> tuple[int, str]:
        return self.runner.live(-1, 1).last_row, self._status_now().key

    def _period_s(self) -> float:
        """Of telling: many listeners hear less often, so that what they cost together is bounded."""
        return max(PERIOD_S, LISTENER_S * self._listeners)

    async def _missed(self, last_event_id: str, now: LiveRows) -> AsyncIterator[str]:
        """What came between an event and the live row `now`."""
        mark = Mark.read(last_event_id)
        if mark is None:
            yield _gap("Last-Event-ID is none of this service; rows come from now on")
            return
        if mark.life == self.state.life and mark.row >= 0:
            kept = self.runner.live(mark.row, ALL_ROWS)
            if not kept.restarted:
                for part in _parts(kept, now.last_row):
                    yield await self._written(part)
                return
        try:
            pieces = await anyio.to_thread.run_sync(missed, self.store, mark, now)
            for piece in pieces:
                yield await anyio.to_thread.run_sync(self._from_store, piece)
            skipped = await anyio.to_thread.run_sync(skipped_experiments, self.store, mark, now)
        except (GapError, StoreError) as error:
            yield _gap(str(error))
            return
        if skipped:
            yield _gap(skipped)

    def _from_store(self, piece: Piece) -> str:
        found = self.store.part(piece.trial, piece.first_row, piece.rows)
        rows = Rows(
            channels=list(piece.trial.channels),
            rows=[column(row) for row in found.T],
            last_row=-1,
            restarted=piece.first_row == 0,
            trial_id=piece.trial.id,
        )
        mark = Mark(self.state.life, -1, piece.trial.id, piece.first_row + piece.rows)
        return _event("rows", rows.model_dump_json(), mark)

    async def _rows_event(self, found: LiveRows) -> str:
        key = (found.trial_id, found.last_row, len(found.rows), found.restarted)
        if key not in self._rows:
            self._rows[key] = await self._written(found)
            while len(self._rows) > MOST_WRITTEN:
                self._rows.popitem(last=False)
        return self._rows.get(key) or await self._written(found)

    async def _written(self, found: LiveRows) -> str:
        """Rows as an event. Many of them are written in a thread: STOP is heard on the event loop."""

        def write() -> str:
            return _event("rows", rows_of(found).model_dump_json(), Mark.of(self.state.life, found))

        return write() if len(found.rows) <= FEW_ROWS else await anyio.to_thread.run_sync(write)

    def _status_now(self) -> _Told:
        now_s = time.monotonic()
        if now_s - self._status.at_s >= PERIOD_S:
            simulated = is_simulated(self.runner.configuration)
            status = status_of(self.runner.status(), simulated, lease_now(self.lease.current()))
            self._status = _Told(now_s, _without_progress(status), _event("status", status.model_dump_json()))
        return self._status


def _parts(kept: LiveRows, last_row: int) -> Iterator[LiveRows]:
    """The rows up to one of a number, in as many as an event carries."""
    wanted = kept.rows[: len(kept.rows) - (kept.last_row - last_row)]
    first_row = last_row + 1 - len(wanted)
    for start in range(0, len(wanted), CHUNK_ROWS):
        rows = wanted[start : start + CHUNK_ROWS]
        end = first_row + start + len(rows) - 1
        yield replace(kept, rows=rows, last_row=end, trial_rows=kept.trial_rows - (kept.last_row - end))


def _without_progress(status: Status) -> str:
    """What makes a status new."""
    still = status.run and status.run.model_copy(update={"progress": 0.0, "left_s": 0.0})
    return repr((status.state, status.prompt, still, status.lease and status.lease.token))


def _gap(detail: str) -> str:
    return _event("gap", json.dumps({"detail": detail}))


def _event(name: str, data: str, mark: Mark | None = None) -> str:
    label = "" if mark is None else f"id: {mark}\n"
    return f"event: {name}\n{label}data: {data}\n\n"
