"""A sequential calibration as a service offers it: in a thread of its own, paused and gone on with from outside."""

import logging
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from bench.calibration import calibrate
from bench.errors import BenchError, BusyError, ExperimentError
from bench.json_types import Values
from bench.runs import event_log
from bench.runs.bench_control import BenchControl, Request, to_its_end
from bench.runs.sequential_calibration import SequentialCalibration, Stand, Wish
from bench.store import Experiment, Store
from compensator.errors import CompensatorError
from drivers.errors import DriveError

State = Literal["none", "running", "pausing", "paused", "fitting", "calibrated", "ended"]
LOOK_S = 0.05
_log = logging.getLogger(__name__)


@dataclass(slots=True)
class Task:
    """One calibration, under way or over.

    Attributes:
        number: of those of this service, from 1.
        stand: how far it was before the experiment that runs.
        paused: whether somebody has asked for a pause.
        waits: whether it stands still between two experiments for it.
        stopped: why it was stopped from outside; "" where it was not.
        reason: why it ended without a calibration.
    """

    number: int
    wish: Wish
    note: str
    stand: Stand
    calibration: SequentialCalibration | None = None
    paused: bool = False
    waits: bool = False
    fitting: bool = False
    stopped: str = ""
    reason: str = ""
    calibration_id: int | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing more moves for it."""
        return bool(self.reason) or self.calibration_id is not None


class Calibrator:
    """One calibration at a time."""

    def __init__(self, runner: BenchControl, store: Store) -> None:
        self._runner, self._store = runner, store
        self._beginning = threading.Lock()
        self._thread: threading.Thread | None = None
        self.task: Task | None = None

    @property
    def is_under_way(self) -> bool:
        """Whether one is."""
        return self.task is not None and not self.task.is_over

    @property
    def engaged(self) -> str:
        """Why nothing else may start; "" where it may."""
        task = self.task
        if task is None or task.is_over:
            return ""
        return f"calibration run {task.number} is under way; wait for its end, or press STOP"

    @property
    def state(self) -> State:
        """What it does, or how the last one ended."""
        task = self.task
        if task is None:
            return "none"
        if task.is_over:
            return "ended" if task.calibration_id is None else "calibrated"
        if task.fitting:
            return "fitting"
        if not task.paused:
            return "running"
        return "paused" if task.waits or self._runner.status().pausing == "paused" else "pausing"

    @property
    def spent_s(self) -> float:
        """Of the joint's time so far, roughly [s]."""
        task, status = self.task, self._runner.status()
        if task is None:
            return 0.0
        running_s = status.progress * status.duration_s if status.outcome == "running" else 0.0
        return task.stand.spent_s + running_s

    def begin(self, wish: Wish, before: Sequence[int] = (), note: str = "") -> int:
        """Begin one: the joint moves. Returns its number.

        Raises:
            BusyError: another one is under way, or an experiment runs.
            NotFoundError: a record of `before` is not there.
        """
        with self._beginning:
            if self.engaged:
                raise BusyError(self.engaged)
            if not self._runner.wait(0.0):
                raise BusyError("an experiment is running; wait for its end, or stop it")
            for one in before:
                self._store.experiment(one)
            number = 1 if self.task is None else self.task.number + 1
            task = Task(number, wish, note, Stand("it begins", wish.budget_s, 0.0))
            bench = self._runner.configuration
            task.calibration = SequentialCalibration(
                bench, self._store, wish, lambda *one: self._run(task, *one), lambda stand: _tell(task, stand), before
            )
            self.task = task
            self._thread = threading.Thread(target=self._carry_out, args=(task,), name="calibration", daemon=True)
            self._thread.start()
            return number

    def pause(self) -> None:
        """Stand still after the trial that runs, with the power off."""
        if self.task is not None:
            self.task.paused = True

    def resume(self) -> None:
        """Go on: the joint moves."""
        if self.task is not None:
            self.task.paused = False
            self._runner.resume()

    def stop(self, reason: str) -> None:
        """End it. The caller stops the runner. Never waits, takes no lock: safe in a signal handler."""
        task = self.task
        if task is not None and not task.is_over:
            task.stopped = task.stopped or reason or "stopped"

    def close(self, reason: str) -> None:
        """End it, and wait for that."""
        self.stop(reason)
        if self._thread is not None:
            self._thread.join()

    def _carry_out(self, task: Task) -> None:
        assert task.calibration is not None
        try:
            ids = task.calibration.carry_out()
            task.fitting = True
            task.calibration_id = calibrate(self._store, ids, True, task.note)
        except (BenchError, DriveError, CompensatorError) as error:
            task.reason = str(error)
        except Exception as error:  # the page must not wait for ever
            _log.exception("the calibration failed")
            task.reason = f"this is a fault of the software: {type(error).__name__}: {error}"
        event_log.note("calibration run ended", number=task.number, made=task.calibration_id, reason=task.reason)

    def _run(self, task: Task, kind: str, parameters: Values, hung: tuple[float, bool] | None) -> Experiment:
        while task.paused and not task.stopped:
            task.waits = True
            time.sleep(LOOK_S)  # a stop wakes nobody: a signal handler may take no lock
        task.waits = False
        if task.stopped:
            raise ExperimentError(task.stopped)
        request = Request(kind, parameters, note=task.note, hung=hung)
        number = to_its_end(self._runner, request, lambda: task.stopped, lambda: self._attend(task))
        found = self._store.experiment(number)
        if found.outcome != "completed":
            raise ExperimentError(f"experiment {found.id} ({kind}): {found.outcome}: {found.reason}")
        return found

    def _attend(self, task: Task) -> None:
        """Also of a pause that was asked for while the run was being started."""
        if task.paused and not self._runner.status().pausing:
            self._runner.pause()


def _tell(task: Task, stand: Stand) -> None:
    task.stand = stand
