"""Experiments run for commissioning, one after the other, each to its end."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from typing import Any

import numpy as np

from bench.commission.questions import CommissionError
from bench.config.configuration import BenchConfiguration
from bench.control.late_cycles import moves_a_joint
from bench.errors import PromptError
from bench.json_types import Values
from bench.runs.bench_control import BenchControl, Request, to_its_end
from bench.runs.connection import Connection
from bench.store import Experiment, Store

NOTE = "friction-bench commission"
ATTEMPTS = 3  # of one motion, on a machine that is busy with other work


class Motions:
    """What moves the joint.

    Args:
        runner: of the bench; closed by whoever made it.
        store: where each motion is recorded.
        hang: asks the person at the bench to hang a load; False where the person gives up. None: what the runner asks
            is answered elsewhere.
        guarded: entered round each motion: what stops the runner on signals.
        given_up: why nothing more may move; "" where it may. Asked all the time.
    """

    def __init__(
        self,
        runner: BenchControl,
        store: Store,
        hang: Callable[[str], bool] | None = None,
        guarded: Callable[[BenchControl], AbstractContextManager[Any]] = nullcontext,
        given_up: Callable[[], str] = lambda: "",
    ) -> None:
        self._runner, self._store, self._hang = runner, store, hang
        self._guarded, self._given_up = guarded, given_up

    def look(self, bench: BenchConfiguration) -> Connection:
        """See `BenchControl.look`; nothing is powered."""
        self._refuse_given_up()
        return self._runner.look(bench)

    def run(self, bench: BenchConfiguration, kind: str, parameters: Values, hung: tuple[float, bool]) -> Experiment:
        """One experiment to its end; again where host or line was late, which says nothing of the joint.

        Raises:
            CommissionError: it did not complete, with the reason.
            BenchError, DriveError: it is refused, or the drive cannot be opened.
        """
        request = Request(kind, parameters, note=NOTE, hung=hung, bench=bench)
        for _ in range(ATTEMPTS):
            self._refuse_given_up()
            with self._guarded(self._runner):
                number = to_its_end(self._runner, request, self._given_up, self._attend)
            found = self._store.experiment(number)
            if found.outcome == "completed":
                return found
            if not self._was_late(found, bench):
                break
            request = replace(request, hung=None)  # what it has left on the arm is asked for
        raise CommissionError(f"{kind} (experiment {number}): {found.outcome}: {found.reason}")

    def lost_cycles(self, ran: Experiment, bench: BenchConfiguration) -> int:
        """How many cycles a late host has lost in the trial in which it lost most; 0 where they move no joint."""
        lost = max((int(trial.results.get("overruns", 0)) for trial in self._store.trials(ran.id)), default=0)
        return lost if moves_a_joint(lost, bench.control.period_s) else 0

    def _was_late(self, ended: Experiment, bench: BenchConfiguration) -> bool:
        """Whether a limit that tripped, or a drive that went off, may be put down to cycles lost or samples too old."""
        trials = self._store.trials(ended.id)
        if not trials:  # the trial of the watchdog, which is on no record: its demand is small, and may be made again
            return ended.outcome == "tripped"
        if ended.outcome not in ("tripped", "failed"):
            return False
        if moves_a_joint(trials[-1].results.get("overruns", 0), bench.control.period_s):
            return True
        ages_s = self._store.recording(trials[-1].id).channels.get("age_s", np.empty(0))
        return bool((ages_s > bench.limits.sample_age_s).any())

    def _refuse_given_up(self) -> None:
        if reason := self._given_up():
            raise CommissionError(reason)

    def _attend(self) -> None:
        prompt = None if self._hang is None else self._runner.status().prompt
        if prompt is None or self._hang is None:
            return
        if not self._hang(prompt.sentence):
            self._runner.stop("the person at the bench gave up")
            return
        try:
            self._runner.answer(prompt.number)
        except PromptError:  # stopped meanwhile
            return
