"""One experiment: under way, or ended."""

import time
from collections.abc import Callable, Mapping
from typing import Any, Self

from bench.client.answer import Answer
from bench.client.connection import Connection
from bench.client.trial import Trial

POLL_S = 0.2


class Run:
    """What `Bench.start` returns.

    Attributes:
        experiment_id: of the record.
    """

    def __init__(self, connection: Connection, experiment_id: int, record: Mapping[str, Any] | None = None) -> None:
        self._connection = connection
        self.experiment_id = experiment_id
        self._record = record

    @property
    def record(self) -> Answer:
        """Kind, parameters, provenance, outcome and why, results; asked for until it has ended."""
        if self._record is None or self._record["finished_utc"] is None:
            self._record = self._connection.get(f"/experiments/{self.experiment_id}")
        return Answer(self._record)

    @property
    def outcome(self) -> str:
        """running, completed, stopped, tripped, failed, interrupted or refused."""
        return str(self.record["outcome"])

    @property
    def reason(self) -> str:
        """Why it ended."""
        return str(self.record["reason"])

    @property
    def results(self) -> Answer:
        """What came out, units in the names."""
        return Answer(self.record["results"])

    def status(self) -> Answer:
        """Outcome, trial, progress (0 .. 1), and the `prompt` that waits for an answer, None where none does."""
        bench = self._connection.get("/bench")
        run = bench["run"] or {}
        if run.get("experiment_id") != self.experiment_id:
            return Answer(experiment_id=self.experiment_id, outcome=self.outcome, reason=self.reason, prompt=None)
        return Answer(run | {"prompt": bench["prompt"]})

    def wait(self, timeout_s: float | None = None, on_prompt: Callable[[str], object] | None = None) -> Self:
        """Wait for the end, however it ends.

        Args:
            timeout_s: None: as long as it takes [s].
            on_prompt: called with what is asked of the person at the bench ("hang 50 g ..."); when it returns, the
                run goes on. None: somebody else answers, or `answer()`.

        Raises:
            TimeoutError: it runs still; nothing was stopped.
        """
        deadline_s = None if timeout_s is None else time.monotonic() + timeout_s
        while self.outcome == "running":
            if on_prompt is not None and (prompt := self.status()["prompt"]) is not None:
                on_prompt(prompt["sentence"])
                self._continue(prompt["number"])
            if deadline_s is not None and time.monotonic() > deadline_s:
                raise TimeoutError(f"experiment {self.experiment_id} runs still after {timeout_s:g} s; stop() ends it")
            time.sleep(POLL_S)
        return self

    def stop(self, reason: str = "") -> Self:
        """Stop the joint, if it is this experiment that runs; returns when it has ended."""
        if self.outcome == "running":
            self._connection.post("/stop", {"reason": reason})
        return self.wait()

    def answer(self) -> None:
        """What was asked of the person at the bench is done: the joint moves on. Nothing happens where none asks."""
        prompt = self.status()["prompt"]
        if prompt is not None:
            self._continue(prompt["number"])

    def remove(self, reason: str) -> None:
        """Remove the experiment with its trials for good; takes an admin's token.

        Args:
            reason: why; the audit log keeps it, with who and when.

        Raises:
            Refused: it runs, or a study or a calibration uses it.
        """
        self._connection.send("DELETE", f"/experiments/{self.experiment_id}", reason=reason)

    def trials(self) -> list[Trial]:
        """Its trials, in the order in which they were made."""
        found = self._connection.items("/trials", experiment_id=self.experiment_id)
        return [Trial(self._connection, one) for one in found]

    def _continue(self, number: int) -> None:
        self._connection.post("/continue", {"prompt": number})

    def __repr__(self) -> str:
        record = self.record
        why = f" ({record['reason']})" if record["reason"] else ""
        return f"<Run {self.experiment_id} {record['kind']}: {record['outcome']}{why}>"

    def _repr_html_(self) -> str:
        return self.record._repr_html_()
