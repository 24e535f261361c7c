"""Experiments run for commissioning, one after the other, each to its end."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

from bench.commission.questions import CommissionError, Person
from bench.config.configuration import BenchConfiguration
from bench.errors import PromptError
from bench.json_types import Values
from bench.runs.runner import HostProcess, Runner
from bench.store import Experiment, Store

_POLL_S = 0.05


class Motions:
    """What moves the joint.

    Args:
        store: where each motion is recorded.
        person: is asked to hang loads.
        guarded: entered with each runner: what stops it on signals.
        host: what its runs take from this process.
    """

    def __init__(
        self,
        store: Store,
        person: Person,
        guarded: Callable[[Runner], AbstractContextManager[Any]],
        host: HostProcess | None = None,
    ) -> None:
        self._store, self._person, self._guarded, self._host = store, person, guarded, host

    def run(self, bench: BenchConfiguration, kind: str, parameters: Values, hung: tuple[float, bool]) -> Experiment:
        """One experiment to its end.

        Args:
            bench: with what is known of the joint so far.
            kind: of experiment.
            parameters: of the kind.
            hung: what hangs on the arm now.

        Raises:
            CommissionError: it did not complete, with the reason.
            BenchError, DriveError: it is refused, or the drive cannot be opened.
        """
        runner = Runner(bench, self._store, self._host)
        try:
            with self._guarded(runner):
                number = runner.start(kind, parameters, note="friction-bench commission", hung=hung)
                while not runner.wait(_POLL_S):
                    self._attend(runner)
        finally:
            runner.close()
        found = self._store.experiment(number)
        if found.outcome != "completed":
            raise CommissionError(f"{kind} (experiment {number}): {found.outcome}: {found.reason}")
        return found

    def _attend(self, runner: Runner) -> None:
        prompt = runner.status().prompt
        if prompt is None:
            return
        if not self._person.done("hang", prompt.sentence):
            runner.stop("the person at the bench gave up")
            return
        try:
            runner.answer(prompt.number)
        except PromptError:  # stopped meanwhile
            return
