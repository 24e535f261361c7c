"""What a service knows of its bench process: as it was told last."""

import threading
from dataclasses import replace

from bench.config.channels import RECORDED
from bench.config.sections import Limits
from bench.runs.bench_control import RunnerStatus
from bench.runs.bench_process.messages import Seen
from bench.runs.live import LiveBuffer


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
