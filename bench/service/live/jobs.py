"""How far a long computation has come: those that were asked for under a name, and what is left of each."""

import asyncio
import threading
import time
from collections import OrderedDict
from collections.abc import AsyncIterator
from typing import Any, Literal

from pydantic import BaseModel, Field

from compensator.lab.progress import Stage

MOST_KEPT = 64  # jobs, the newest
LOOK_EVERY_S = 0.1
BEGINS_WITHIN_S = 5.0  # who follows may come before the request that is followed
PACES = 0.2, 5.0  # of the machine, against the last time: what is beyond is chance

State = Literal["waiting", "computing", "ended"]


class JobRecord(BaseModel):
    """Where a computation is."""

    job: str = Field(description="its name, as the request gave it in `X-Job`")
    what: str = Field(examples=["diagnose"])
    state: State = Field(description="waiting: others are computed before it")
    stage: str = Field(description="what is done now, in words; empty where it tells nothing")
    stages_done: int
    stages: int = Field(description="to be done in all; 0 where it tells nothing")
    share: float = Field(description="of its time, as far as known from the last time; 0..1")
    passed_s: float
    left_s: float | None = Field(description="as long as it took the last time, at its pace of now; null: not known")


class Job:
    """One computation. The thread that computes writes, the event loop reads.

    Args:
        name: as it was asked for; what: which function.
        usual_s: stage -> how long it took the last time [s]; added to as stages end.
    """

    def __init__(self, name: str, what: str, usual_s: dict[str, float]) -> None:
        self.name, self.what, self._usual_s = name, what, usual_s
        self.state: State = "waiting"
        self._stage = Stage((), 0)
        self._begun_s = self._entered_s = time.monotonic()
        self._expected_s = 0.0  # what the stages that have ended took the last time
        self._ended_s: float | None = None

    def tell(self, stage: Stage) -> None:
        """It has come to a stage, or further within one."""
        now_s = time.monotonic()
        if self.state == "waiting":
            self.state, self._begun_s = "computing", now_s
        if stage.name != self._stage.name:
            if self._stage.name:
                self._expected_s += self._usual_s.get(self._stage.name, 0.0)
                self._usual_s[self._stage.name] = now_s - self._entered_s
            self._entered_s = now_s
        self._stage = stage

    def end(self) -> None:
        """It has ended, well or not."""
        self.state, self._ended_s = "ended", time.monotonic()

    def record(self) -> JobRecord:
        """As it is now."""
        stage = self._stage
        passed_s = (self._ended_s or time.monotonic()) - self._begun_s
        left_s = 0.0 if self.state == "ended" else self._left_s(stage, passed_s)
        known = left_s is not None and passed_s + left_s > 0.0
        share = passed_s / (passed_s + (left_s or 0.0)) if known else (stage.done + stage.part) / max(stage.of, 1)
        return JobRecord(
            job=self.name,
            what=self.what,
            state=self.state,
            stage=f"{stage.name}: {stage.within}" if stage.within else stage.name,
            stages_done=stage.done,
            stages=stage.of,
            share=share,
            passed_s=passed_s,
            left_s=left_s,
        )

    def _left_s(self, stage: Stage, passed_s: float) -> float | None:
        to_do = stage.names[stage.done :]
        if not to_do or any(name not in self._usual_s for name in to_do):
            return None
        now_s = self._usual_s[to_do[0]]
        done = min(0.95, max(stage.part, (time.monotonic() - self._entered_s) / max(now_s, 1e-3)))
        low, high = PACES
        expected_s = self._expected_s + done * now_s
        pace = min(max(passed_s / expected_s, low), high) if expected_s > LOOK_EVERY_S else 1.0
        return pace * ((1.0 - done) * now_s + sum(self._usual_s[name] for name in to_do[1:]))


class Jobs:
    """The newest jobs by name."""

    def __init__(self) -> None:
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._usual_s: dict[str, dict[str, float]] = {}  # of each function by itself
        self._lock = threading.Lock()

    def begin(self, name: str, what: str) -> Job:
        """A job of that name; an earlier one of the same name is forgotten."""
        with self._lock:
            job = self._jobs[name] = Job(name, what, self._usual_s.setdefault(what, {}))
            while len(self._jobs) > MOST_KEPT:
                self._jobs.popitem(last=False)
            return job

    def find(self, name: str) -> Job | None:
        """None where there is none of that name."""
        return self._jobs.get(name)

    async def stream(self, name: str, state: Any) -> AsyncIterator[str]:
        """Events as text, one at each change, until the job or the service ends.

        Args:
            name: of the job; it may begin a little later.
            state: of the application; `ending` ends the stream.
        """
        end_s, shown = time.monotonic() + BEGINS_WITHIN_S, ""
        while not state.ending:
            job = self.find(name)
            if job is None and time.monotonic() > end_s:
                return
            if job is not None:
                record = job.record()
                key = f"{record.state} {record.stage} {record.passed_s:.0f} {record.share:.2f}"
                if key != shown:
                    shown = key
                    yield f"event: progress\ndata: {record.model_dump_json()}\n\n"
                if record.state == "ended":
                    return
            await asyncio.sleep(LOOK_EVERY_S)
