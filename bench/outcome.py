"""How a run ended, and how every way it can end becomes that."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from bench.errors import LimitTrip
from bench.recorder import Recorder
from bench.stop_request import StopRequest

OutcomeName = Literal["running", "completed", "stopped", "tripped", "failed", "interrupted", "refused"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a run ended.

    Attributes:
        outcome: one of `OutcomeName`.
        reason: why, in words; empty when completed.
        results: what the procedure returned.
        cycles: control cycles run.
        overruns: cycles lost because the host was late.
    """

    outcome: OutcomeName
    reason: str = ""
    results: dict[str, Any] = field(default_factory=dict)
    cycles: int = 0
    overruns: int = 0

    def with_notes(self, notes: list[str]) -> "Outcome":
        """The same, with what went wrong while it ended; it is not a completed run then."""
        # a failure of the sink ends the run and is met again at the close: said once
        new = [note for note in notes if note not in self.reason]
        if not new:
            return self
        outcome: OutcomeName = "failed" if self.outcome == "completed" else self.outcome
        return replace(self, outcome=outcome, reason=_joined(self.reason, *new))

    def recorded(self, recorder: Recorder, time_s: float) -> "Outcome":
        """The same, written as the trial's last event, with what went wrong while the record was closed."""
        ending = self
        try:
            recorder.event(time_s, "end", _joined(self.outcome, self.reason))
        except Exception as error:
            ending = ending.with_notes([str(error)])
        try:
            recorder.close()
        except Exception as error:
            ending = ending.with_notes([str(error)])
        return ending


class StopRequested(Exception):
    """Raised by the cycles of a loop when the stop is set."""


def outcome_of(check: Callable[[], str], cycles: Callable[[], dict[str, Any]], stop: StopRequest) -> Outcome:
    """Run the cycles, and turn every way they can end into an outcome.

    Args:
        check: takes a sample with the power off; what it says forbids motion, "" does not.
        cycles: run the procedure to its end, and return its results.
        stop: an interrupt from the keyboard sets it too, so that a series of trials ends with the first.
    """
    try:
        refusal = check()
        if refusal:
            return Outcome("refused", refusal)
        return Outcome("completed", results=cycles())
    except StopRequested:
        return Outcome("stopped", stop.reason)
    except KeyboardInterrupt:
        stop.ask("interrupted from the keyboard")
        return Outcome("stopped", stop.reason)
    except LimitTrip as trip:
        return Outcome("tripped", str(trip))
    except Exception as error:
        return Outcome("failed", str(error) or type(error).__name__)


def _joined(*reasons: str) -> str:
    return "; ".join(dict.fromkeys(reason for reason in reasons if reason))
