"""Where the time of a control cycle goes, part by part: `python -m tests.sim_backend.cycle_cost [KIND ...]`.

A trial is run once, and what passes between loop, drive and procedure is noted. Then each part is given the same again,
alone: the drive its calls, the procedure its readings, the loop both from the notes. Times are CPU seconds of one
thread in the best of some rounds: other work on the machine does not count.
"""

import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import partial
from time import process_time, thread_time
from typing import Any, NamedTuple

from bench.config.configuration import BenchConfiguration, default_configuration
from bench.control.clock import VirtualClock
from bench.control.cycle import Action, Procedure, Reading
from bench.control.drive_factory import Equipment, make_equipment
from bench.control.ending import StopRequest
from bench.control.limits import Guard
from bench.control.loop import ControlLoop, joint_loop
from bench.control.servo import current_servo
from bench.evaluation.paper.measurements import Measurement, measure, quietly
from bench.experiments.kind import TrialPlan
from bench.experiments.registry import find_kind, parse_parameters
from bench.store import Store
from drivers.contract import Command, Drive, Sample

KINDS = ("steps", "speed-sweep", "excitation")
PERIOD_S, ROUNDS = 1e-3, 9


def at_1_khz() -> BenchConfiguration:
    """The demo's bench, faster."""
    configuration = default_configuration()
    control = configuration.control.model_copy(update={"period_s": PERIOD_S})
    return configuration.model_copy(update={"control": control})


class Notes(NamedTuple):
    """What passed in one trial: the drive's calls and samples, what the procedure was given and what it gave."""

    calls: list[tuple[str, Any]]
    samples: list[Sample]
    actions: list[Action]
    readings: list[Reading]
    results: dict[str, Any]


class NotedDrive:
    """A drive whose calls and samples are noted."""

    def __init__(self, drive: Drive, notes: Notes) -> None:
        self._drive, self._notes = drive, notes
        self.describe = drive.describe
        self.enable = partial(self._call, "enable")
        self.disable = partial(self._call, "disable")

    def exchange(self, command: Command) -> Sample:
        sample: Sample = self._call("exchange", command)
        self._notes.samples.append(sample)
        return sample

    def _call(self, name: str, *given: Any) -> Any:
        self._notes.calls.append((name, given))
        return getattr(self._drive, name)(*given)


class PlayedDrive:
    """Answers as the notes say, whatever is asked."""

    def __init__(self, drive: Drive, notes: Notes) -> None:
        samples = iter(notes.samples)
        self.describe = drive.describe
        self.exchange = lambda _command: next(samples)
        self.enable = self.disable = lambda *_mode: None


class NoSink:
    """Forgets what it is given."""

    def append(self, rows: Any, events: Any = ()) -> None:
        """Nothing to do."""


def noted(procedure: Procedure, notes: Notes) -> Procedure:
    """The procedure, its two sides noted."""
    action = next(procedure)
    while True:
        notes.actions.append(action)
        reading = yield action
        notes.readings.append(reading)
        try:
            action = procedure.send(reading)
        except StopIteration as end:
            notes.results.update(end.value or {})
            return notes.results


def played(notes: Notes) -> Procedure:
    """The actions of the notes, whatever is read."""
    for action in notes.actions:  # noqa: UP028  (what is sent is not passed on)
        yield action
    return {}


def opened(configuration: BenchConfiguration, plan: TrialPlan) -> Equipment:
    """A drive of its own, open, its load hung."""
    equipment = make_equipment(configuration)
    equipment.drive.open(configuration.control.period_s)
    equipment.technician.hang_load(plan.load_kg, plan.balanced)
    return equipment


def loop_of(configuration: BenchConfiguration, drive: Any) -> ControlLoop[Action, Reading]:
    """The loop as a station makes it."""
    guard, servo = Guard(configuration.limits), current_servo(configuration.rig)
    return joint_loop(drive, VirtualClock(), guard, configuration.control.period_s, servo)


def take_notes(configuration: BenchConfiguration, plan: TrialPlan) -> Notes:
    """Run a trial."""
    notes = Notes([], [], [], [], {})
    loop = loop_of(configuration, NotedDrive(opened(configuration, plan).drive, notes))
    outcome = loop.run(noted(plan.procedure(), notes), NoSink(), StopRequest())
    if outcome.outcome != "completed":
        raise RuntimeError(f"{plan.name}: {outcome.outcome}: {outcome.reason}")
    return notes


def best_s(prepare: Callable[[], Callable[[], object]], rounds: int = ROUNDS) -> float:
    """Shortest CPU time of what `prepare` returns."""
    times = []
    for _ in range(rounds):
        work = prepare()
        began = thread_time()
        work()
        times.append(thread_time() - began)
    return min(times)


def drive_work(configuration: BenchConfiguration, plan: TrialPlan, notes: Notes) -> Callable[[], None]:
    """The calls of the notes, to a drive of its own."""
    drive = opened(configuration, plan).drive
    calls = [(getattr(drive, name), given) for name, given in notes.calls]

    def work() -> None:
        for call, given in calls:
            call(*given)

    return work


def procedure_work(plan: TrialPlan, notes: Notes) -> Callable[[], None]:
    """The procedure, given its readings."""
    procedure: Procedure = plan.procedure()

    def work() -> None:
        send = procedure.send
        next(procedure)
        try:
            for reading in notes.readings:
                send(reading)
        except StopIteration:
            pass

    return work


def loop_work(configuration: BenchConfiguration, plan: TrialPlan, notes: Notes) -> Callable[[], object]:
    """The loop between a drive and a procedure that only play what is noted."""
    loop = loop_of(configuration, PlayedDrive(make_equipment(configuration).drive, notes))
    return partial(loop.run, played(notes), NoSink(), StopRequest())


def together_work(configuration: BenchConfiguration, plan: TrialPlan) -> Callable[[], object]:
    """Loop, drive and procedure as in a trial, and no store."""
    loop = loop_of(configuration, opened(configuration, plan).drive)
    return partial(loop.run, plan.procedure(), NoSink(), StopRequest())


def whole_us(configuration: BenchConfiguration, kind: str) -> float:
    """CPU time per cycle of a whole experiment: with its store, and the beginning and end of each trial."""
    with tempfile.TemporaryDirectory() as folder, Store.open(f"sqlite:///{folder}/bench.sqlite") as store:

        def once() -> float:
            began = process_time()
            identity = measure(configuration, store, Measurement(kind, {}), quietly).id
            used_s = process_time() - began
            return 1e6 * used_s / sum(trial.results["cycles"] for trial in store.trials(identity))

        return min(once() for _ in range(3))


def report(kind: str) -> Iterator[str]:
    """Yield a line per part."""
    configuration, found = at_1_khz(), find_kind(kind)
    plans = found.plan(parse_parameters(found, {}), configuration)
    plan = plans[len(plans) // 2]
    notes = take_notes(configuration, plan)
    us = 1e6 / len(notes.readings)
    parts = {
        "drive and plant": us * best_s(lambda: drive_work(configuration, plan, notes)),
        "procedure, its servo and search": us * best_s(lambda: procedure_work(plan, notes)),
        "loop: eq. (3), limits, rows": us * best_s(lambda: loop_work(configuration, plan, notes)),
    }
    together_us, most_us = us * best_s(lambda: together_work(configuration, plan)), whole_us(configuration, kind)
    parts |= {
        "what they cost one another (caches)": together_us - sum(parts.values()),
        "store, start and end of each trial": most_us - together_us,
        "together": most_us,
    }
    yield f"{kind}: {len(notes.readings)} cycles of {1e3 * PERIOD_S:g} ms, CPU time per cycle"
    for name, part_us in parts.items():
        yield f"  {part_us:5.1f} us  {name}"
    yield f"  {1e6 * PERIOD_S / most_us:5.0f} x real time"


if __name__ == "__main__":
    for kind_name in sys.argv[1:] or KINDS:
        for line in report(kind_name):
            print(line, flush=True)
