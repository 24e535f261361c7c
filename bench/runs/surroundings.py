"""What a runner takes from the process that it runs in."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from typing import Any

from bench.control.ending import StopRequest


@dataclass(frozen=True)
class Surroundings:
    """What differs between a program of its own and the bench process of a service.

    Attributes:
        new_stop: makes the wish to end of each new experiment.
        during_run: entered by the thread of the control loop while an experiment runs; called with whether the wall
            clock paces it.
        facts: kept with the provenance of each experiment, JSON-able.
    """

    new_stop: Callable[[], StopRequest] = StopRequest
    during_run: Callable[[bool], AbstractContextManager[Any]] = nullcontext
    facts: Mapping[str, Any] = field(default_factory=dict)
