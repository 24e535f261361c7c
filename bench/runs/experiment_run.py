"""One experiment under way: its trials one after the other, in a thread of its own, and how it ended."""

import logging
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.control.commissioned import WATCHDOG_RESULT, WATCHDOG_SEEN
from bench.control.cycle import Reading
from bench.control.ending import Outcome, OutcomeName, StopRequest
from bench.control.loop import ControlLoop
from bench.control.power.torque_off import torque_off_reason
from bench.control.recorder import Event, Sink
from bench.control.servo import held_back
from bench.control.station import Station
from bench.errors import ExperimentError, LimitTrip
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan
from bench.json_types import Value
from bench.runs import event_log, session
from bench.runs.bench_control import Pausing, Request
from bench.runs.live import LiveBuffer
from bench.runs.session import Session
from bench.runs.watchdog_proof import WatchdogProof, prove_watchdog
from bench.store import Store
from bench.store.upkeep.space import SpaceNeed
from drivers.contract import Watchdog
from drivers.errors import DriveError

PAUSE_POLL_S = 0.05
COMPUTED_WITH = "scipy.special"  # by searches for the load: a first import within a trial would cost it some cycles


@dataclass(frozen=True, slots=True)
class Prepared:
    """Everything that an experiment needs, checked; what it moves is open and off.

    Attributes:
        real_time: whether the wall clock paces it.
        proves_watchdog: the drive's watchdog is tried before its first trial.
        doubt: what a person has to look at before the first; "" where there is nothing.
        ask: asks the person; False where the experiment was stopped before the answer.
    """

    kind: ExperimentKind
    parameters: Parameters
    plans: list[TrialPlan]
    duration_s: float
    station: Station
    loop: ControlLoop[Any, Any]
    space: SpaceNeed
    session: Session
    real_time: bool
    proves_watchdog: bool = False
    doubt: str = ""
    ask: Callable[[str], bool] = lambda _sentence: True


@dataclass(slots=True)
class ExperimentRun:
    """One experiment, from the request to the end of its record.

    Attributes:
        experiment_id: of its record, once there is one.
        outcome, reason: "running" until the record is closed.
        trial_index: the trial that runs, from 0.
        paused: whether it stands between two trials, with the power off, until it may go on.
    """

    request: Request
    experiment_id: int | None = None
    outcome: OutcomeName = "running"
    reason: str = ""
    trial_index: int = 0
    paused: bool = False
    stop_request: StopRequest = field(default_factory=StopRequest)
    _pause: threading.Event = field(default_factory=threading.Event)
    _prepared: Prepared | None = None
    _finished: list[FinishedTrial] = field(default_factory=list)
    _proof: WatchdogProof | None = None

    def stop(self, reason: str) -> None:
        """Stop within one control cycle; also an experiment that is only about to begin."""
        self.stop_request.ask(reason)

    def is_stopped(self) -> bool:
        """Whether it has been asked to stop."""
        return self.stop_request.is_set()

    def pause(self) -> None:
        """Stand still before the next trial."""
        self._pause.set()

    def resume(self) -> None:
        """Go on."""
        self._pause.clear()

    @property
    def pausing(self) -> Pausing:
        """Whether it stands still, or is going to."""
        if self.paused:
            return "paused"
        return "asked" if self._pause.is_set() else ""

    def end(self, outcome: OutcomeName, reason: str) -> None:
        """Say how it ended; the outcome last, so that who sees it sees the reason too."""
        self.reason = reason
        self.outcome = outcome

    @property
    def reading(self) -> Reading | None:
        """The last one."""
        return self._prepared.loop.last_reading if self._prepared is not None else None

    @property
    def trial_count(self) -> int:
        """Trials of the experiment."""
        return len(self._prepared.plans) if self._prepared is not None else 0

    @property
    def duration_s(self) -> float:
        """Estimate of the whole; 0 where it is not known yet."""
        return self._prepared.duration_s if self._prepared is not None else 0.0

    @property
    def progress(self) -> float:
        """Share that is done, 0 .. 1; within a trial by the estimated duration."""
        prepared, reading = self._prepared, self.reading
        if self.outcome == "completed":
            return 1.0
        if prepared is None or not prepared.plans:
            return 0.0
        trial_s = max(prepared.duration_s / len(prepared.plans), 1e-3)
        share = min(reading.time_s / trial_s, 0.99) if reading is not None else 0.0
        return (self.trial_index + share) / len(prepared.plans)

    def carry_out(self, prepared: Prepared, store: Store, live: LiveBuffer) -> None:
        """Run the trials, close the drive, close the record. Never raises: how it ended is in `outcome`."""
        self._prepared = prepared
        kind, parameters = self.request.kind, prepared.parameters.model_dump(mode="json", exclude_defaults=True)
        event_log.note("run started", experiment_id=self.experiment_id, kind=kind, parameters=parameters)
        outcome, reason = self._run_trials(prepared, store, live)
        try:
            prepared.station.close()
        except Exception as error:
            outcome, reason = _worse(outcome, reason, f"closing the drive: {error}")
        results: dict[str, Value] = {}
        try:
            results = prepared.kind.summarise(prepared.parameters, self._finished)
        except Exception as error:
            outcome, reason = _worse(outcome, reason, f"no summary: {str(error) or type(error).__name__}")
        if self._proof is not None:
            results |= {WATCHDOG_RESULT: self._proof.watchdog.value, WATCHDOG_SEEN: self._proof.sentence}
        try:
            store.finish_experiment(self._id(), outcome, reason, results)
        except Exception as error:
            outcome, reason = _worse(outcome, reason, f"the record could not be closed: {error}")
        level = logging.INFO if outcome in ("completed", "stopped") else logging.ERROR
        event_log.note("run ended", level, experiment_id=self.experiment_id, kind=kind, outcome=outcome, reason=reason)
        self.end(outcome, reason)

    def _run_trials(self, prepared: Prepared, store: Store, live: LiveBuffer) -> tuple[OutcomeName, str]:
        if prepared.doubt and not prepared.ask(prepared.doubt):
            return "stopped", self.stop_request.reason
        import_module(COMPUTED_WITH)
        bench, drive = prepared.station.benches[0], prepared.station.drives[0]
        held = held_back(bench.servo, bench.search, drive.describe())
        for index, plan in enumerate(prepared.plans):
            self.trial_index = index
            self._wait_while_paused()
            try:
                if not self._prepare_arm(plan, prepared.station):
                    return "stopped", self.stop_request.reason
                if prepared.proves_watchdog and self._proof is None and (ending := self._prove_watchdog(prepared)):
                    return ending
                store.require_space(prepared.space, trials=1)
                outcome = self._run_trial(plan, prepared, store, live)
            except Exception as error:
                why = torque_off_reason(prepared.station.drives[0]) if isinstance(error, DriveError) else ""
                words = "; ".join(filter(None, (why, str(error) or type(error).__name__)))
                return "refused" if why else "failed", f"trial '{plan.name}': {words}"
            if outcome.outcome != "completed":
                words = "; ".join(filter(None, (held if outcome.outcome == "failed" else "", outcome.reason)))
                return outcome.outcome, f"trial '{plan.name}': {words}"
        return "completed", ""

    def _prove_watchdog(self, prepared: Prepared) -> tuple[OutcomeName, str] | None:
        """Try the drive's watchdog, before anything else moves it; how the run ends where it must not go on."""
        [drive], [bench] = prepared.station.drives, prepared.station.benches
        try:
            self._proof = prove_watchdog(drive, bench, self.is_stopped)
        except LimitTrip as trip:
            return "tripped", f"trial of the watchdog: {trip}"
        if self._proof is None:
            return "stopped", self.stop_request.reason
        if self._proof.watchdog is Watchdog.NONE and not self._proof.is_admitted:
            return "failed", f"the drive's watchdog does not stop it: {self._proof.sentence}"
        return None

    def _wait_while_paused(self) -> None:
        while self._pause.is_set() and not self.is_stopped():
            self.paused = True
            time.sleep(PAUSE_POLL_S)  # a stop wakes nobody: a signal handler may take no lock
        self.paused = False

    def _prepare_arm(self, plan: TrialPlan, station: Station) -> bool:
        """Have the load hung, with the power off; False where a stop came before it hung."""
        if not self.is_stopped():
            try:
                station.prepare(plan.load_kg, plan.balanced, plan.wall_rad)
            except ExperimentError:
                if not self.is_stopped():
                    raise
        return not self.is_stopped()

    def _run_trial(self, plan: TrialPlan, prepared: Prepared, store: Store, live: LiveBuffer) -> Outcome:
        conditions = {**plan.conditions, session.CONDITION: prepared.session.seconds()}
        loop = prepared.loop
        writer = store.begin_trial(self._id(), plan.name, self.request.kind, conditions, loop.channels)
        live.begin_trial(loop.channels, writer.trial_id)
        outcome = loop.run(plan.procedure(), _WatchedSink(writer, live), self.stop_request)
        prepared.session.passed(loop.last_reading.time_s if loop.last_reading else 0.0)
        self._finished.append(FinishedTrial(plan.name, conditions, outcome.outcome, outcome.results))
        results = {**outcome.results, "cycles": outcome.cycles, "overruns": outcome.overruns}
        writer.finish(outcome.outcome, outcome.reason, results)
        event_log.note(
            "trial ended",
            experiment_id=self.experiment_id,
            trial_id=writer.trial_id,
            name=plan.name,
            outcome=outcome.outcome,
            reason=outcome.reason,
            cycles=outcome.cycles,
            overruns=outcome.overruns,
        )
        return outcome

    def _id(self) -> int:
        if self.experiment_id is None:
            raise RuntimeError("an experiment was carried out before its record was begun")
        return self.experiment_id


class _WatchedSink:
    """Commits to the store, then shows to whoever watches."""

    def __init__(self, sink: Sink, live: LiveBuffer) -> None:
        self._sink = sink
        self._live = live

    def append(self, rows: NDArray[np.float64], events: Sequence[Event] = ()) -> None:
        self._sink.append(rows, events)
        if len(rows):
            self._live.append(rows)


def _worse(outcome: OutcomeName, reason: str, problem: str) -> tuple[OutcomeName, str]:
    """An ending with one more problem; a completed run is not, then."""
    return ("failed" if outcome == "completed" else outcome), "; ".join(filter(None, (reason, problem)))
