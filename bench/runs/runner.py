"""Runs one experiment at a time: start, watch, stop."""

import threading
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from bench.calibration import with_friction
from bench.config.channels import PAIR_RECORDED, RECORDED
from bench.config.configuration import BenchConfiguration
from bench.control import commissioned, drive_faults
from bench.control.clock import VirtualClock, WallClock
from bench.control.cycle import OFF
from bench.control.drive_factory import has_hardware, is_simulated, seed_of
from bench.control.drive_faults import DriveState
from bench.control.ending import StopRequest
from bench.control.prompt import PromptDesk
from bench.control.station import Station, make_station
from bench.errors import BenchError, BusyError, ParameterError
from bench.experiments.kinds import homing
from bench.experiments.parts.refusal import refuse_modes
from bench.experiments.registry import ExperimentKind, find_kind, parse_parameters
from bench.json_types import Values
from bench.provenance import provenance
from bench.runs import stoppable
from bench.runs.bench_control import PACES, BenchControl, Pace, Request, RunnerStatus
from bench.runs.connection import Connection, connect
from bench.runs.count_check import count_doubt
from bench.runs.experiment_run import ExperimentRun, Prepared
from bench.runs.live import LiveBuffer, LiveRows
from bench.runs.session import session_of
from bench.store import Store
from bench.store.upkeep.space import SpaceNeed
from drivers.contract import Description, Watchdog
from drivers.errors import DriveError

WINDING_UP_S = 5.0  # what the thread of a run may take once its record is closed and the drive is off


@dataclass(frozen=True)
class HostProcess:
    """What a runner takes from the process that it runs in: a program of its own, or the bench process of a service.

    Attributes:
        new_stop: makes the stop request of each new experiment.
        during_run: entered by the thread of the control loop while an experiment runs; called with whether the wall
            clock paces it.
        facts: kept with the provenance of each experiment, JSON-able.
    """

    new_stop: Callable[[], StopRequest] = stoppable.new_stop
    during_run: Callable[[bool], AbstractContextManager[Any]] = nullcontext
    facts: Mapping[str, Any] = field(default_factory=dict)


class Runner(BenchControl):
    """The bench in operation, its control loop in a thread of this process.

    Args:
        configuration: of the bench.
        store: where trials are kept. Rows are written to it from a thread of the control loop's own.
        host: what it takes from the process that it runs in.
    """

    def __init__(self, configuration: BenchConfiguration, store: Store, host: HostProcess | None = None) -> None:
        self.configuration = configuration
        self._store = store
        self._host = host or HostProcess()
        self._starting = threading.Lock()
        self._thread: threading.Thread | None = None
        self._run: ExperimentRun | None = None
        self._descriptions: tuple[Description, ...] = ()  # of the joint; or of the slave, and the master
        self._live = LiveBuffer(RECORDED)
        self._desk = PromptDesk()
        self._closed = False

    def begin(self, request: Request) -> int:
        """See `BenchControl.start`."""
        kind = find_kind(request.kind)
        with self._starting:
            self._refuse_when_busy()
            run = ExperimentRun(request, stop_request=self._host.new_stop())
            self._run = run  # from here on `stop` reaches it
            try:
                return self._launch(run, kind)
            except BaseException as error:
                if run.outcome == "running":
                    run.end("failed", str(error) or type(error).__name__)
                raise

    def status(self) -> RunnerStatus:
        """See `BenchControl`."""
        run = self._run
        limits = (self._configuration_of(run.request) if run is not None else self.configuration).limits
        description = self._descriptions[0] if self._descriptions else None
        if run is None:
            return RunnerStatus(None, "", "", "", 0, 0, 0.0, None, description, limits)
        outcome, reason = run.outcome, run.reason
        return RunnerStatus(
            run.experiment_id, run.request.kind, outcome, reason if outcome != "running" else "", run.trial_index,
            run.trial_count, run.progress, run.reading, description, limits, self._desk.pending,
            run.pausing if outcome == "running" else "", run.duration_s,
        )  # fmt: skip

    def answer(self, prompt_number: int) -> None:
        """See `BenchControl`."""
        self._desk.answer(prompt_number)

    def look(self, bench: BenchConfiguration) -> Connection:
        """See `BenchControl`."""
        with self._starting:
            self._refuse_when_busy()
            return connect(bench)

    def read_drives(self) -> tuple[DriveState, ...]:
        """See `BenchControl`."""
        with self._starting:
            self._refuse_when_busy()
            return drive_faults.read_drives(self.configuration)

    def clear_faults(self, shown: str) -> tuple[DriveState, ...]:
        """See `BenchControl`."""
        with self._starting:
            self._refuse_when_busy()
            return drive_faults.clear_faults(self.configuration, shown)

    def live(self, after_row: int = -1, limit: int = 2000) -> LiveRows:
        """See `BenchControl`."""
        return self._live.since(after_row, limit)

    def stop(self, reason: str = "") -> None:
        """See `BenchControl`; takes no lock of the runner."""
        run = self._run
        if run is not None and run.outcome == "running":
            run.stop(reason)

    def pause(self) -> None:
        """See `BenchControl`."""
        run = self._run
        if run is not None:
            run.pause()

    def resume(self) -> None:
        """See `BenchControl`."""
        run = self._run
        if run is not None:
            run.resume()

    def wait(self, timeout_s: float | None = None) -> bool:
        """See `BenchControl`."""
        thread = self._thread
        if thread is not None:
            thread.join(timeout_s)
        return thread is None or not thread.is_alive()

    def close(self) -> None:
        """See `BenchControl`."""
        self._closed = True
        self.stop("the bench was closed")
        with self._starting:  # a start that was under way has heard of the stop
            self.wait()

    def _refuse_when_busy(self) -> None:
        if self._closed:
            raise BusyError("the bench is closed; nothing can be started")
        run = self._run
        # who sees the end of a run may start at once: what is left of its thread is a moment
        if not self.wait(0.0 if run is None or run.outcome == "running" else WINDING_UP_S) and run is not None:
            name = f"experiment {run.experiment_id} ({run.request.kind})"
            raise BusyError(f"{name} is running; wait for its end, or stop it")

    def _launch(self, run: ExperimentRun, kind: ExperimentKind) -> int:
        configuration = with_friction(self._store, self._configuration_of(run.request))
        try:
            prepared = self._prepare(configuration, run, kind)
        except (BenchError, DriveError) as error:
            # failed starts are on record too
            run.experiment_id = self._begin(configuration, run.request, run.request.parameters)
            run.end("refused" if isinstance(error, BenchError) else "failed", str(error))
            self._store.finish_experiment(run.experiment_id, run.outcome, run.reason, {})
            raise
        try:
            run.experiment_id = self._begin(configuration, run.request, prepared.parameters.model_dump(mode="json"))
        except BaseException:
            prepared.station.close()
            raise
        thread = threading.Thread(target=self._carry_out, args=(run, prepared), name=f"experiment {run.experiment_id}")
        thread.start()
        self._thread = thread
        return run.experiment_id

    def _carry_out(self, run: ExperimentRun, prepared: Prepared) -> None:
        self._thread = threading.current_thread()  # who sees the run may wait for it, before its start has come back
        with stoppable.moving(), self._host.during_run(prepared.real_time):
            run.carry_out(prepared, self._store, self._live)

    def _prepare(self, configuration: BenchConfiguration, run: ExperimentRun, kind: ExperimentKind) -> Prepared:
        """Check everything that can be checked before motion, and open the drive."""
        real_time = _is_real_time(configuration, run.request.pace)
        clock = WallClock() if real_time else VirtualClock()
        parameters = parse_parameters(kind, run.request.parameters)
        kind.refuse(parameters, configuration)
        plans = kind.plan(parameters, configuration)
        duration_s = kind.duration_s(parameters, configuration)
        channels = len(PAIR_RECORDED if kind.pair else RECORDED)
        space = SpaceNeed.of(
            duration_s / len(plans), configuration.control.period_s, configuration.store.reserve_mb, channels
        )
        self._store.require_space(space, len(plans))
        session = session_of(configuration, self._store)
        ask = partial(self._desk.ask, given_up=run.is_stopped)
        station = make_station(configuration, kind.pair, clock, ask)
        if run.request.hung is not None:
            station.assume(*run.request.hung)
        self._descriptions = ()
        try:
            loop = station.open()
            self._descriptions = tuple(
                self._as_proven(bench, drive.describe())
                for bench, drive in zip(station.benches, station.drives, strict=True)
            )
            for description in self._descriptions:
                refuse_modes(kind.name, kind.modes(parameters), description)
            if kind.name not in commissioned.BEFORE_IT:
                self._require_commissioned(station)
            # a count that was reset is what a search for the zero is for
            doubt = "" if kind.name == homing.NAME else self._count_doubt(station)
        except BaseException:
            station.close()
            raise
        parameters = kind.adapt(parameters, self._descriptions[0].modes)
        plans = kind.plan(parameters, configuration)
        proves = kind.name in commissioned.BEFORE_IT and not is_simulated(
            configuration
        )  # virtual time knows no silence
        return Prepared(
            kind, parameters, plans, duration_s, station, loop, space, session, real_time, proves, doubt, ask
        )

    def _require_commissioned(self, station: Station) -> None:
        """Refuse a real drive that has not passed the commissioning move."""
        for bench, drive in zip(station.benches, station.drives, strict=True):
            if not is_simulated(bench):
                commissioned.require_commissioned(self._store, provenance(bench, drive.describe()))

    def _count_doubt(self, station: Station) -> str:
        """Of the joint, or of the slave; "" where its count is not in doubt."""
        bench, drive = station.benches[0], station.drives[0]
        if is_simulated(bench):
            return ""
        return count_doubt(self._store, bench, self._descriptions[0], lambda: drive.exchange(OFF).position_rad)

    def _as_proven(self, bench: BenchConfiguration, found: Description) -> Description:
        """What the drive says of itself, with what its commissioning has seen of its watchdog."""
        if is_simulated(bench) or found.watchdog is not Watchdog.CONFIGURED:
            return found
        seen = commissioned.watchdog_of(self._store, provenance(bench, found))
        return found if seen is None else replace(found, watchdog=seen)

    def _configuration_of(self, request: Request) -> BenchConfiguration:
        return request.bench or self.configuration

    def _begin(self, configuration: BenchConfiguration, request: Request, parameters: Values) -> int:
        drives, benches = self._descriptions, [configuration]
        if find_kind(request.kind).pair and configuration.master is not None:
            benches.append(configuration.of_master())
        hardware = any(has_hardware(bench) for bench in benches)
        simulated = not hardware or (bool(drives) and all(drive.simulated for drive in drives))
        return self._store.begin_experiment(
            request.kind,
            parameters,
            "simulated" if simulated else "real",
            provenance(
                configuration,
                drives[0] if drives else None,
                seed_of(configuration),
                drives[1] if len(drives) > 1 else None,
            )
            | dict(self._host.facts),
            configuration.rig.model_dump(mode="json", exclude_none=True),
            request.operator,
            request.note,
        )


def _is_real_time(configuration: BenchConfiguration, pace: Pace | None) -> bool:
    simulated = is_simulated(configuration)
    if pace is not None and pace not in PACES:
        raise ParameterError(f"pace is '{pace}'; allowed is {' or '.join(PACES)}")
    if pace == "fast" and not simulated:
        raise ParameterError("pace is 'fast'; a real drive runs in real time")
    return pace == "real-time" or not simulated
