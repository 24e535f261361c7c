"""What the queue is doing, and how long that takes."""

from dataclasses import dataclass
from typing import Literal

from bench.control.drive_factory import has_hardware
from bench.runs.bench_control import BenchControl
from bench.runs.queue.conductor import Conductor
from bench.runs.queue.items import HANG_S, load_changes
from bench.store.tables.queue import WAITING, QueueItem

MOST_SHOWN = 1000  # of the items that wait, in one answer
State = Literal["idle", "running", "pausing", "paused", "held"]


@dataclass(frozen=True, slots=True)
class QueueState:
    """The queue now.

    Attributes:
        state: "idle": nothing waits; "running"; "pausing": it stands still after the trial that runs; "paused": it does
            so, within an experiment; "held": nothing is started until somebody resumes.
        reason: why it is held or paused; or which item another process runs, that this one waits for.
        waiting: a page of what waits, in order.
        next_offset: of the next page; None on the last.
        duration_s: estimate of all of them, in the joint's time, hanging of loads included.
        load_changes: how often something has to be hung yet.
        ended: what came out last, newest first.
    """

    state: State
    reason: str
    running: QueueItem | None
    waiting: list[QueueItem]
    waiting_count: int
    next_offset: int | None
    duration_s: float
    left_s: float
    load_changes: int
    ended: list[QueueItem]


def queue_state(
    conductor: Conductor, runner: BenchControl, ended: int = 0, limit: int = MOST_SHOWN, offset: int = 0
) -> QueueState:
    """The queue of a bench, now; with a page of what waits, and so many of the items that came out of it."""
    waiting = conductor.table.items(WAITING)
    running, status = conductor.running, runner.status()
    waiting = [item for item in waiting if running is None or item.id != running.id]
    changes = load_changes([*([running] if running else []), *waiting]) - (len(running.loads[:1]) if running else 0)
    hanging_s = HANG_S * changes if has_hardware(runner.configuration) else 0.0
    coming_s = sum(item.duration_s for item in waiting) + hanging_s
    held = conductor.held
    if running is not None:
        state: State = "running" if held is None else "paused" if status.pausing == "paused" else "pausing"
    elif held is not None:
        state = "held"
    else:
        state = "running" if waiting else "idle"
    duration_s = coming_s + (running.duration_s if running else 0.0)
    left_s = coming_s + (status.left_s if running else 0.0)
    out = conductor.table.ended(ended) if ended else []
    shown, count = waiting[offset : offset + limit], len(waiting)
    more = offset + limit if offset + limit < count else None
    reason = held or (conductor.elsewhere if waiting else "")
    return QueueState(state, reason, running, shown, count, more, duration_s, left_s, changes, out)
