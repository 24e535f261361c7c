"""Commissioning as a service offers it: in a thread of its own, its questions answered from outside."""

import logging
import threading
from dataclasses import dataclass, field
from typing import Literal

from bench.commission.bench_table import BenchTable
from bench.commission.desk import Asked, Desk
from bench.commission.drive_section import is_known, section_of
from bench.commission.evidence import Evidence
from bench.commission.flow import Commission, Commissioned
from bench.commission.motions import Motions
from bench.commission.simulated_hand import hands_at
from bench.commission.steps import STEPS
from bench.errors import BenchError, BusyError
from bench.runs import event_log
from bench.runs.bench_control import BenchControl
from bench.store import Store
from drivers.errors import DriveError

State = Literal["none", "asking", "working", "commissioned", "refused"]
ENDED = "the service was ended"
UNKNOWN = (
    "the joint of this bench is not known yet: commission it (view Commission, or POST /commission), then start the "
    "service with the bench.toml that comes of it"
)
_log = logging.getLogger(__name__)


@dataclass(slots=True)
class Course:
    """One commissioning, under way or over.

    Attributes:
        number: of those of this service, from 1.
        step: key of the step that it is at.
        stopped: why it was stopped from outside; "" where it was not.
        refusal: why it did not get through, once that is so.
        ended: what came of it, once it got through.
    """

    number: int
    step: str = STEPS[0].key
    evidence: Evidence = field(default_factory=Evidence)
    stopped: str = ""
    refusal: str = ""
    ended: Commissioned | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing more moves for it."""
        return bool(self.refusal) or self.ended is not None


class Guide:
    """One commissioning at a time, of the drive that the bench's configuration names.

    Every motion is an experiment of the bench, with STOP, limits, record and the drive's watchdog.
    """

    def __init__(self, runner: BenchControl, store: Store) -> None:
        self._runner, self._store = runner, store
        self._beginning = threading.Lock()
        self._thread: threading.Thread | None = None
        self.course: Course | None = None
        self._desk = Desk(self._given_up)
        self._is_known = is_known(runner.configuration)

    @property
    def now(self) -> tuple[State, Asked | None]:
        """What it does, or how the last one ended; and the question that waits for an answer."""
        course, asked = self.course, self._desk.asked
        if course is None:
            return "none", None
        if course.is_over:
            return ("commissioned" if course.ended is not None else "refused"), None
        if course.stopped or asked is None:
            return "working", None
        return "asking", asked

    @property
    def is_under_way(self) -> bool:
        """Whether one is."""
        return self.course is not None and not self.course.is_over

    @property
    def engaged(self) -> str:
        """Why nothing else may start; "" where it may."""
        course = self.course
        if course is None or course.is_over:
            return "" if self._is_known else UNKNOWN
        return f"commissioning {course.number} is under way (step '{course.step}'); end it, or press STOP"

    @property
    def obstacle(self) -> str:
        """Why the drive of this bench cannot be commissioned; "" where it can."""
        try:
            section_of(self._runner.configuration)
        except BenchError as error:
            return str(error)
        return ""

    def begin(self, name: str, travel_rad: float) -> int:
        """Begin one; nothing moves before a person has answered. Returns its number.

        Args:
            name: of the bench, in its bench.toml; "": as now.
            travel_rad: how far the arm may turn to either side of straight down.

        Raises:
            BusyError: another one is under way, or an experiment runs.
            CommissionError: the bench's drive cannot be commissioned.
        """
        with self._beginning:
            if self.is_under_way:
                raise BusyError(self.engaged)
            if not self._runner.wait(0.0):
                raise BusyError("an experiment is running; wait for its end, or stop it")
            configuration = self._runner.configuration
            section = section_of(configuration)
            course = Course(1 if self.course is None else self.course.number + 1)
            person = hands_at(section, self._desk)
            flow = Commission(
                BenchTable(name or configuration.name, section, travel_rad),
                person,
                Motions(self._runner, self._store, given_up=self._given_up),
                course.evidence,
                lambda key: setattr(course, "step", key),
            )
            self.course = course
            self._thread = threading.Thread(target=_carry_out, args=(flow, course), name="commissioning", daemon=True)
            self._thread.start()
            return course.number

    def answer(self, number: int, value: float | None) -> str:
        """Answer question `number`; see `Desk.answer`. Returns its key."""
        return self._desk.answer(number, value)

    def stop(self, reason: str) -> None:
        """End it. The caller stops the runner. Never waits, takes no lock: safe in a signal handler."""
        course = self.course
        if course is not None and not course.is_over:
            course.stopped = course.stopped or reason or "stopped"

    def close(self) -> None:
        """End it, and wait for that."""
        self.stop(ENDED)
        if self._thread is not None:
            self._thread.join()

    def _given_up(self) -> str:
        return "" if self.course is None else self.course.stopped


def _carry_out(flow: Commission, course: Course) -> None:
    event_log.note("commissioning started", number=course.number)
    try:
        course.ended = flow.run()
    except (BenchError, DriveError) as error:
        course.refusal = str(error)
    except Exception as error:  # the page must not wait for ever
        _log.exception("commissioning failed")
        course.refusal = f"this is a fault of the software: {type(error).__name__}: {error}"
    event_log.note("commissioning ended", number=course.number, step=course.step, refusal=course.refusal)
