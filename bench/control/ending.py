"""How a run ends: the request to stop it, and its outcome."""

import threading
from dataclasses import dataclass, field, replace
from typing import Literal

from bench.json_types import Value

OutcomeName = Literal["running", "completed", "stopped", "tripped", "failed", "interrupted", "refused"]
UNNAMED = "stop was asked for"


class StopRequest(threading.Event):
    """Set once; the first reason is the one that is kept. Waits for nothing: safe in a signal handler."""

    def __init__(self) -> None:
        super().__init__()
        self.reason = UNNAMED

    def ask(self, reason: str = "") -> None:
        """Ask for the end."""
        if not self.is_set():
            self.reason = reason or self.reason
            self.set()


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a run ended.

    Attributes:
        outcome: one of `OutcomeName`.
        reason: why, in words; empty when completed.
        cycles: control cycles run.
        overruns: cycles lost because the host was late.
    """

    outcome: OutcomeName
    reason: str = ""
    results: dict[str, Value] = field(default_factory=dict)
    cycles: int = 0
    overruns: int = 0

    def in_words(self) -> str:
        """Outcome and reason."""
        return _joined(self.outcome, self.reason)

    def with_notes(self, notes: list[str]) -> "Outcome":
        """The same, and what went wrong while the run ended; it is not a completed run then."""
        if not notes:
            return self
        outcome: OutcomeName = "failed" if self.outcome == "completed" else self.outcome
        # a failure of the sink ends the run and is met again when the recorder is closed: it is said once
        new = [note for note in notes if note not in self.reason]
        return replace(self, outcome=outcome, reason=_joined(self.reason, *new))


def _joined(*reasons: str) -> str:
    return "; ".join(dict.fromkeys(reason for reason in reasons if reason))
