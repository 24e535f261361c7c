"""A host that is late: a limit that trips for it says so, and braking lasts as long as it is given."""

from bench.config.configuration import default_configuration
from bench.control.clock import VirtualClock
from bench.control.cycle import Action
from bench.control.drive_factory import make_equipment
from bench.control.ending import Outcome, StopRequest
from bench.control.late_cycles import BRAKING_S, LateCycles
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from bench.control.servo import current_servo
from bench.experiments.kinds.chirp import KIND, ChirpParameters
from drivers.contract import Command, Mode, Status
from tests.control.fake_drive import FakeDrive, ListSink
from tests.control.loops import PERIOD_S, on_each, run

LATE_S = 0.5


class LateClock(VirtualClock):
    """A host that comes late now and then, while the drive goes on with what it was told last.

    Args:
        period_s: of the control.
        late: of these cycles.
        meanwhile: called for each cycle that is lost.
    """

    def __init__(self, period_s, late, meanwhile=lambda: None, late_s=LATE_S):
        self.overruns, self.waits = 0, 0
        self._late, self._lost, self._meanwhile = late, round(late_s / period_s), meanwhile

    def wait(self):
        self.waits += 1
        if self.waits in self._late:
            for _ in range(self._lost):
                self._meanwhile()
            self.overruns += self._lost


class HeldDrive:
    """A drive, and its last command once more."""

    def __init__(self, drive):
        self._drive = drive
        self._last = Command(Mode.OFF)

    def __getattr__(self, name):
        return getattr(self._drive, name)

    def exchange(self, command):
        self._last = command
        return self._drive.exchange(command)

    def hold(self):
        self._drive.exchange(self._last)


def chirp(late: set[int], tracking_error_rad: float = 1.0) -> Outcome:
    configuration = default_configuration()
    limits = configuration.limits.model_copy(update={"tracking_error_rad": tracking_error_rad})
    configuration = configuration.model_copy(update={"limits": limits})
    period_s = configuration.control.period_s
    parameters = ChirpParameters(duration_s=6.0, amplitude_rad=0.5, low_hz=0.5, high_hz=1.5)
    (trial,) = KIND.plan(parameters, configuration)
    made = make_equipment(configuration).drive
    made.open(period_s)
    try:
        drive = HeldDrive(made)
        clock = LateClock(period_s, late, drive.hold)
        loop = joint_loop(drive, clock, Guard(limits), period_s, current_servo(configuration.rig))
        return loop.run(trial.procedure(), ListSink(), StopRequest())
    finally:
        made.close()


def test_a_limit_that_trips_because_the_host_was_late_says_so():
    outcome = chirp({900}, tracking_error_rad=0.3)
    assert outcome.outcome == "tripped"
    assert "tracking error is" in outcome.reason
    assert "the host was late by 0.5 s (100 cycles)" in outcome.reason


def test_a_limit_that_trips_in_time_says_nothing_of_the_host():
    outcome = chirp(set(), tracking_error_rad=0.003)
    assert outcome.outcome == "tripped"
    assert "host" not in outcome.reason


def test_what_was_lost_long_before_is_not_blamed():
    late = LateCycles(clock := LateClock(0.01, {1}), 0.01)
    clock.wait()
    late.look(cycle=1)
    assert late.explain(cycle=10)
    assert late.explain(cycle=100) == ""


def test_a_cycle_or_two_are_not_blamed_but_many_of_them_are():
    late = LateCycles(clock := LateClock(0.01, range(1, 9), late_s=0.01), 0.01)
    told = []
    for cycle in range(1, 5):
        clock.wait()
        late.look(cycle)
        told.append(late.explain(cycle))
    assert told[:2] == ["", ""]
    assert "0.04 s (4 cycles)" in told[3]


@on_each
def test_a_joint_brakes_for_its_time_and_not_for_a_number_of_late_cycles(setup):
    def push():
        while True:
            yield setup.action(Action(Command(Mode.DUTY, 0.2)))

    drive = FakeDrive()
    braking = []

    def keep_braking(cycle, sample):
        if "quick_stop" not in drive.calls:
            return sample
        braking.append(cycle)
        return sample._replace(status=Status.QUICK_STOP)

    drive.alter = keep_braking
    clock = LateClock(PERIOD_S, range(1, 10_000), late_s=0.245)  # each cycle
    stop = StopRequest()
    drive.before = lambda cycle: stop.ask() if cycle > 5 else None
    assert run(setup, drive, push(), stop, clock=clock).outcome.outcome == "stopped"
    assert len(braking) == round(BRAKING_S / 0.25)
