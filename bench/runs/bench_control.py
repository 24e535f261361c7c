"""What may be asked of a bench in operation, wherever its control loop runs."""

from typing import Protocol

from bench.config.configuration import BenchConfiguration
from bench.json_types import Values
from bench.runs.live import LiveRows
from bench.runs.runner import Pace, RunnerStatus


class BenchControl(Protocol):
    """A bench in operation: `Runner` in this process, `RemoteRunner` in a process of its own.

    Both raise the same errors. Every method may be called from any thread.
    """

    @property
    def configuration(self) -> BenchConfiguration:
        """Of the bench."""

    def start(
        self,
        kind: str,
        parameters: Values,
        operator: str = "",
        note: str = "",
        pace: Pace | None = None,
        hung: tuple[float, bool] | None = None,
    ) -> int:
        """Start an experiment; it moves the joint. Returns the id of its record; see `Runner.start`."""

    def status(self) -> RunnerStatus:
        """What the bench is doing, or did last. Never waits."""

    def answer(self, prompt_number: int) -> None:
        """Go on: the person has done what prompt `prompt_number` asked for."""

    def live(self, after_row: int = -1, limit: int = 2000) -> LiveRows:
        """Rows of the running trial after the one of a number, as they are recorded; at most the newest `limit`."""

    def stop(self, reason: str = "") -> None:
        """Stop what runs, within one control cycle. Never waits: safe in a signal handler."""

    def pause(self) -> None:
        """Let what runs stand still after its present trial, with the power off; nothing where nothing runs."""

    def resume(self) -> None:
        """Let what was paused go on: the joint moves."""

    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until nothing runs; False where that takes longer than `timeout_s`."""

    def close(self) -> None:
        """Stop what runs, and wait until the joint is off. Nothing can be started afterwards."""
