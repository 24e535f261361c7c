"""What may be asked of a bench in operation, wherever its control loop runs, and what it answers."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from bench.config.configuration import BenchConfiguration
from bench.config.sections import Limits
from bench.control.cycle import Reading
from bench.control.drive_faults import DriveState
from bench.control.ending import OutcomeName
from bench.control.prompt import Prompt
from bench.json_types import Values
from bench.runs.connection import Connection
from bench.runs.live import LiveRows
from drivers.contract import Description

Pace = Literal["real-time", "fast"]
Pausing = Literal["", "asked", "paused"]
PACES: tuple[Pace, ...] = ("real-time", "fast")
FAILED_POWER_OFF = ("power-off failed", "quick stop failed")  # notes of `bench.control.loop` in the reason of a run


@dataclass(frozen=True, slots=True)
class Request:
    """An experiment that a user asks for; see `BenchControl.start`.

    Attributes:
        bench: configuration of this one experiment, where it is not the bench's own: commissioning is finding it out.
    """

    kind: str
    parameters: Values
    operator: str = ""
    note: str = ""
    pace: Pace | None = None
    hung: tuple[float, bool] | None = None
    bench: BenchConfiguration | None = None


@dataclass(frozen=True, slots=True)
class RunnerStatus:
    """What the bench is doing, or did last.

    Attributes:
        experiment_id: None before the first experiment.
        kind: "" before the first experiment.
        outcome: "running" while it runs; "" before the first.
        trial_index: the trial that runs, from 0.
        progress: share that is done, 0 .. 1.
        description: the drive, once it has been opened.
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
    def power_off(self) -> Literal["confirmed", "failed"] | None:
        """Whether the drive took its power off at the end, as the control loop noted it; None while it runs."""
        if self.outcome == "running":
            return None
        return "failed" if any(note in self.reason for note in FAILED_POWER_OFF) else "confirmed"

    @property
    def left_s(self) -> float:
        """Estimate of what is left, in the joint's time; 0 where nothing runs."""
        return (1.0 - self.progress) * self.duration_s if self.outcome == "running" else 0.0


class BenchControl(ABC):
    """A bench in operation: `Runner` in this process, `RemoteRunner` in a process of its own.

    Both raise the same errors. Every method may be called from any thread.
    """

    configuration: BenchConfiguration

    def start(
        self,
        kind: str,
        parameters: Values,
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
            BenchProcessError: the control loop is in a process of its own, which cannot be started, or has ended.
        """
        return self.begin(Request(kind, parameters, operator, note, pace, hung))

    @abstractmethod
    def begin(self, request: Request) -> int:
        """Start what is asked for; see `start`."""

    @abstractmethod
    def status(self) -> RunnerStatus:
        """What the bench is doing, or did last. Never waits."""

    @abstractmethod
    def answer(self, prompt_number: int) -> None:
        """Go on: the person has done what prompt `prompt_number` asked for.

        Raises:
            PromptError: nothing is asked, or something else.
        """

    @abstractmethod
    def look(self, bench: BenchConfiguration) -> Connection:
        """Open a drive, run cycles with the power off, and close it.

        Args:
            bench: with the drive's section; the bench's own, or one that commissioning is finding out.

        Raises:
            BusyError: an experiment runs, or the runner is closed.
            DriveError: it cannot be opened, or does not answer.
            ConfigurationError: it does not fit the control period.
        """

    @abstractmethod
    def read_drives(self) -> tuple[DriveState, ...]:
        """What each drive of the bench says of itself; they are opened for it, and closed again.

        Raises:
            BusyError: an experiment runs, or the runner is closed.
            DriveError: one cannot be opened, or does not answer.
        """

    @abstractmethod
    def clear_faults(self, shown: str) -> tuple[DriveState, ...]:
        """Clear the faults that a person has been shown (`drive_faults.faults_in_words`); the power stays off.

        Raises:
            FaultChangedError: they are others by now; nothing was cleared.
            DriveFault: a cause is still there.
            BusyError, DriveError: as `read_drives`.
        """

    @abstractmethod
    def live(self, after_row: int = -1, limit: int = 2000) -> LiveRows:
        """Rows of the running trial after the one of a number, as they are recorded; at most the newest `limit`."""

    @abstractmethod
    def stop(self, reason: str = "") -> None:
        """Stop what runs: within one control cycle the joint is braked, then powered off.

        Never waits: safe in a signal handler.
        """

    @abstractmethod
    def pause(self) -> None:
        """Let what runs stand still after its present trial, with the power off; nothing where nothing runs."""

    @abstractmethod
    def resume(self) -> None:
        """Let what was paused go on: the joint moves."""

    @abstractmethod
    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until nothing runs; False where that takes longer than `timeout_s`."""

    @abstractmethod
    def close(self) -> None:
        """Stop what runs, and wait until the joint is off. Nothing can be started afterwards."""


_POLL_S = 0.05


def to_its_end(
    runner: BenchControl,
    request: Request,
    given_up: Callable[[], str],
    attend: Callable[[], None] = lambda: None,
) -> int:
    """Begin an experiment, and wait until it is over. Returns the id of its record.

    Args:
        runner: of the bench.
        request: what to begin.
        given_up: why the task goes on no more; "" as long as it does. Asked all the time, so that a stop that comes
            while the run is being started stops it, too.
        attend: called all the time.

    Raises:
        BenchError, DriveError: it is refused, or the drive cannot be opened.
    """
    number = runner.begin(request)
    while not runner.wait(_POLL_S):
        if reason := given_up():
            runner.stop(reason)
        attend()
    return number
