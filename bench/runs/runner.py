"""Runs one experiment at a time: start, watch, stop."""

import threading
from dataclasses import dataclass
from typing import Any, Literal

from bench.calibration import with_friction
from bench.config.channels import PAIR_RECORDED, RECORDED
from bench.config.configuration import BenchConfiguration
from bench.config.limits import Limits
from bench.control import commissioned
from bench.control.clock import VirtualClock, WallClock
from bench.control.cycle import Reading
from bench.control.drive_factory import has_hardware, is_simulated, seed_of
from bench.control.ending import OutcomeName
from bench.control.prompt import Prompt, PromptDesk
from bench.control.station import Station, make_station
from bench.errors import BenchError, BusyError, ParameterError
from bench.experiments.parts.refusal import refuse_modes
from bench.experiments.registry import ExperimentKind, find_kind, parse_parameters
from bench.provenance import provenance
from bench.runs.experiment_run import ExperimentRun, Pausing, Prepared, Request
from bench.runs.live import LiveBuffer, LiveRows
from bench.runs.session import session_of
from bench.runs.surroundings import Surroundings
from bench.store import Store
from bench.store.upkeep.space import SpaceNeed
from drivers.contract import Description
from drivers.errors import DriveError

Pace = Literal["real-time", "fast"]
PACES: tuple[Pace, ...] = ("real-time", "fast")


@dataclass(frozen=True, slots=True)
class RunnerStatus:
    """What the bench is doing, or did last.

    Attributes:
        experiment_id: None before the first experiment.
        kind: "" before the first experiment.
        outcome: "running" while it runs; "" before the first.
        reason: why it ended.
        trial_index: the trial that runs, from 0.
        trial_count: trials of the experiment.
        progress: share that is done, 0 .. 1.
        reading: the last one.
        description: the drive, once it has been opened.
        limits: of the bench.
        prompt: what the person at the bench is asked to do before it goes on; the power is off meanwhile.
        pausing: "asked": it will stand still after the trial that runs; "paused": it does, with the power off.
        duration_s: estimate of the whole, in the joint's time.
    """

    experiment_id: int | None
    kind: str
    outcome: OutcomeName | Literal[""]
    reason: str
    trial_index: int
    trial_count: int
    progress: float
    reading: Reading | None
    description: Description | None
    limits: Limits
    prompt: Prompt | None = None
    pausing: Pausing = ""
    duration_s: float = 0.0

    @property
    def left_s(self) -> float:
        """Estimate of what is left, in the joint's time; 0 where nothing runs."""
        return (1.0 - self.progress) * self.duration_s if self.outcome == "running" else 0.0


class Runner:
    """The bench in operation.

    Args:
        configuration: of the bench.
        store: where trials are kept. Rows are written to it from a thread of the control loop's own.
        surroundings: what it takes from the process that it runs in.
    """

    def __init__(
        self, configuration: BenchConfiguration, store: Store, surroundings: Surroundings | None = None
    ) -> None:
        self.configuration = configuration
        self._store = store
        self._surroundings = surroundings or Surroundings()
        self._starting = threading.Lock()
        self._thread: threading.Thread | None = None
        self._run: ExperimentRun | None = None
        self._descriptions: tuple[Description, ...] = ()  # of the joint; or of the slave, and the master
        self._live = LiveBuffer(RECORDED)
        self._desk = PromptDesk()
        self._closed = False

    def start(
        self,
        kind: str,
        parameters: dict[str, Any],
        operator: str = "",
        note: str = "",
        pace: Pace | None = None,
        hung: tuple[float, bool] | None = None,
    ) -> int:
        """Start an experiment; it moves the joint.

        Args:
            kind: its name in the registry.
            parameters: what differs from the defaults.
            operator: who stands at the bench.
            note: kept with the record.
            pace: "real-time", or "fast" as a simulated drive allows and then has by default.
            hung: load_kg, and whether balanced, of what the experiment before left on the arm; None: not known,
                somebody is asked.

        Returns:
            The id of its record.

        Raises:
            BusyError: another one runs, or the runner is closed.
            UnknownKindError: no such kind.
            ParameterError, LimitError, ConfigurationError: it is refused; that is on record too.
            DriveError: the drive cannot be opened; that is on record too.
        """
        found = find_kind(kind)
        with self._starting:
            self._refuse_when_busy()
            request = Request(kind, parameters, operator, note, hung)
            run = ExperimentRun(request, stop_request=self._surroundings.new_stop())
            self._run = run  # from here on `stop` reaches it
            try:
                return self._launch(run, found, pace)
            except BaseException as error:
                if run.outcome == "running":
                    run.end("failed", str(error) or type(error).__name__)
                raise

    def status(self) -> RunnerStatus:
        """What the bench is doing, or did last. Never waits."""
        run, limits = self._run, self.configuration.limits
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
        """Go on: the person has done what prompt `prompt_number` asked for.

        Raises:
            PromptError: nothing is asked, or something else.
        """
        self._desk.answer(prompt_number)

    def live(self, after_row: int = -1, limit: int = 2000) -> LiveRows:
        """Rows of the running trial after the one of a number, as they are recorded; at most the newest `limit`."""
        return self._live.since(after_row, limit)

    def stop(self, reason: str = "") -> None:
        """Stop what runs: within one control cycle the joint is braked, then powered off.

        Never waits, and takes no lock of the runner: safe in a signal handler.
        """
        run = self._run
        if run is not None and run.outcome == "running":
            run.stop(reason)

    def pause(self) -> None:
        """Let what runs stand still after its present trial, with the power off; nothing where nothing runs."""
        run = self._run
        if run is not None:
            run.pause()

    def resume(self) -> None:
        """Let what was paused go on: the joint moves."""
        run = self._run
        if run is not None:
            run.resume()

    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until nothing runs; False where that takes longer than `timeout_s`."""
        thread = self._thread
        if thread is not None:
            thread.join(timeout_s)
        return thread is None or not thread.is_alive()

    def close(self) -> None:
        """Stop what runs, and wait until the joint is off. Nothing can be started afterwards."""
        self._closed = True
        self.stop("the bench was closed")
        with self._starting:  # a start that was under way has heard of the stop
            self.wait()

    def _refuse_when_busy(self) -> None:
        if self._closed:
            raise BusyError("the bench is closed; nothing can be started")
        if not self.wait(0.0) and self._run is not None:
            name = f"experiment {self._run.experiment_id} ({self._run.request.kind})"
            raise BusyError(f"{name} is running; wait for its end, or stop it")

    def _launch(self, run: ExperimentRun, kind: ExperimentKind, pace: Pace | None) -> int:
        configuration = with_friction(self._store, self.configuration)
        try:
            prepared = self._prepare(configuration, run, kind, pace)
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
        with self._surroundings.during_run(prepared.real_time):
            run.carry_out(prepared, self._store, self._live)

    def _prepare(
        self, configuration: BenchConfiguration, run: ExperimentRun, kind: ExperimentKind, pace: Pace | None
    ) -> Prepared:
        """Check everything that can be checked before motion, and open the drive."""
        real_time = self._is_real_time(pace)
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
        station = make_station(
            configuration, kind.pair, clock, lambda sentence: self._desk.ask(sentence, run.is_stopped)
        )
        if run.request.hung is not None:
            station.assume(*run.request.hung)
        self._descriptions = ()
        try:
            loop = station.open()
            self._descriptions = tuple(drive.describe() for drive in station.drives)
            refuse_modes(kind.name, kind.modes(parameters), self._descriptions[0])
            if kind.name != commissioned.KIND:
                self._require_commissioned(station)
        except BaseException:
            station.close()
            raise
        return Prepared(kind, parameters, plans, duration_s, station, loop, space, session, real_time)

    def _require_commissioned(self, station: Station) -> None:
        """Refuse a real drive that has not passed the commissioning move."""
        for bench, drive in zip(station.benches, station.drives, strict=True):
            if not is_simulated(bench):
                commissioned.require_commissioned(self._store, provenance(bench, drive.describe()))

    def _is_real_time(self, pace: Pace | None) -> bool:
        simulated = is_simulated(self.configuration)
        if pace is not None and pace not in PACES:
            raise ParameterError(f"pace is '{pace}'; allowed is {' or '.join(PACES)}")
        if pace == "fast" and not simulated:
            raise ParameterError("pace is 'fast'; a real drive runs in real time")
        return pace == "real-time" or not simulated

    def _begin(self, configuration: BenchConfiguration, request: Request, parameters: dict[str, Any]) -> int:
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
            | dict(self._surroundings.facts),
            configuration.rig.model_dump(mode="json", exclude_none=True),
            request.operator,
            request.note,
        )
