"""Every way in which a run of one joint or a pair ends: it brakes, the power is off, and the outcome says why."""

import threading

import pytest

from bench.control.cycle import OFF, Action
from bench.control.ending import StopRequest
from drivers.contract import Status
from drivers.errors import DriveConnectionError, DriveFault
from tests.control.fake_drive import FakeDrive, ListSink
from tests.control.loops import PUSH, StillPowered, on_each, push, run


@on_each
def test_stop_is_honoured_within_one_cycle(setup):
    stop = StopRequest()
    drive = FakeDrive(before=lambda cycle: stop.set() if cycle == 7 else None)
    ran = run(setup, drive, push(setup, 1000), stop)
    assert (ran.outcome.outcome, ran.outcome.reason) == ("stopped", "stop was asked for")
    assert ran.outcome.cycles == 7
    for one in ran.drives.values():
        assert one.commands[8:] == [OFF]  # the braking


def raise_at(cycle, error):
    """Raise once, as a signal does, or for good, as a fault does."""
    raised = []

    def before(now):
        if now >= cycle and not (raised and isinstance(error, KeyboardInterrupt)):
            raised.append(now)
            raise error

    return before


@on_each
def test_a_fault_of_the_drive_ends_in_power_off(setup):
    ran = run(setup, FakeDrive(before=raise_at(5, DriveFault("fake", "over-current"))), push(setup, 1000))
    assert (ran.outcome.outcome, ran.outcome.reason) == ("failed", "drive 'fake': over-current")


@on_each
@pytest.mark.parametrize("status", [Status.DISABLED, Status.FAULT])
def test_a_drive_that_switches_itself_off_is_noticed(setup, status):
    drive = FakeDrive(alter=lambda cycle, s: s._replace(status=status) if cycle == 5 else s)
    ran = run(setup, drive, push(setup, 1000))
    assert ran.outcome.outcome == "failed"
    assert f"{setup.prefix}status is {status.name} during motion" in ran.outcome.reason


@on_each
def test_an_interrupt_from_the_keyboard_ends_in_power_off_and_stops_what_follows(setup):
    stop = StopRequest()
    ran = run(setup, FakeDrive(before=raise_at(5, KeyboardInterrupt())), push(setup, 1000), stop)
    assert (ran.outcome.outcome, ran.outcome.reason) == ("stopped", "interrupted from the keyboard")
    assert stop.is_set()


@on_each
def test_what_is_no_exception_passes_through_but_powers_off(setup):
    threads = threading.active_count()
    with pytest.raises(SystemExit):
        run(setup, FakeDrive(before=raise_at(5, SystemExit(3))), push(setup, 1000))
    assert threading.active_count() == threads


@on_each
def test_an_exception_of_the_procedure_ends_in_power_off(setup):
    def procedure():
        yield setup.action(Action(OFF))
        yield setup.action(PUSH)
        raise ZeroDivisionError("float division by zero")

    outcome = run(setup, FakeDrive(), procedure()).outcome
    assert (outcome.outcome, outcome.reason) == ("failed", "float division by zero")


@on_each
def test_the_procedure_is_closed_when_it_is_cut_short(setup):
    closed = []

    def procedure():
        try:
            while True:
                yield setup.action(PUSH)
        finally:
            closed.append(True)

    run(setup, FakeDrive(before=raise_at(3, KeyboardInterrupt())), procedure())
    assert closed


@on_each
def test_a_procedure_that_raises_when_it_is_closed_leaves_no_recorder_behind(setup):
    def procedure():
        try:
            while True:
                yield setup.action(PUSH)
        finally:
            raise ValueError("not closed")

    threads = threading.active_count()
    ran = run(setup, FakeDrive(before=raise_at(3, KeyboardInterrupt())), procedure())
    assert (ran.outcome.outcome, ran.outcome.reason) == ("stopped", "interrupted from the keyboard; not closed")
    assert ran.sink.events[-1][1] == "end"
    assert threading.active_count() == threads


@on_each
@pytest.mark.parametrize("block", [0, 2])
def test_a_failing_sink_ends_in_power_off_and_keeps_what_came_before(setup, block):
    sink = ListSink(fail_on_block=block)
    outcome = run(setup, FakeDrive(), push(setup, 200_000), sink=sink).outcome
    assert outcome.outcome == "failed"
    assert outcome.reason == "the store failed: No space left on device"
    assert len(sink.blocks) == block
    assert outcome.cycles < 200_000


@on_each
def test_a_sink_that_fails_on_the_last_block_is_not_a_completed_run(setup):
    outcome = run(setup, FakeDrive(), push(setup, 3), sink=ListSink(fail_on_block=0)).outcome
    assert outcome.outcome == "failed"


@on_each
def test_power_off_is_tried_again_when_it_is_interrupted(setup):
    drive = FakeDrive(before=raise_at(5, KeyboardInterrupt()))
    disable, attempts = drive.disable, []

    def interrupted_once():
        attempts.append(True)
        if len(attempts) == 1:
            raise KeyboardInterrupt
        disable()

    drive.disable = interrupted_once
    outcome = run(setup, drive, push(setup, 1000)).outcome
    assert outcome.outcome == "stopped"
    assert f"{setup.prefix}power-off failed: KeyboardInterrupt" in outcome.reason
    assert len(attempts) == 2


@on_each
def test_a_failing_quick_stop_does_not_keep_the_power_on(setup):
    drive = FakeDrive(before=raise_at(5, ValueError("boom")))
    drive.quick_stop = lambda: (_ for _ in ()).throw(OSError("port is gone"))
    outcome = run(setup, drive, push(setup, 1000)).outcome
    assert outcome.reason == f"boom; {setup.prefix}quick stop failed: port is gone"


@on_each
def test_a_drive_that_cannot_be_powered_off_is_told_and_every_other_one_is_off(setup):
    others = []

    def other():
        others.append(FakeDrive())
        return others[-1]

    drive = FakeDrive()
    drive.disable = lambda: (_ for _ in ()).throw(DriveConnectionError("fake", "no answer"))
    with pytest.raises(StillPowered) as left:
        run(setup, drive, push(setup), other=other)
    assert left.value.names == [setup.name]
    assert left.value.outcome.outcome == "failed"
    assert f"{setup.prefix}power-off failed: drive 'fake': no answer" in left.value.outcome.reason
    assert [one.calls[-1] for one in others] == ["disable"] * len(others)


class Failing(FakeDrive):
    """Raises in one of its calls, from a number of times on; the power goes all the same when it is told to go."""

    def __init__(self, call, error=None, after=1, until=10**9):
        super().__init__()
        self.failing, self.error = call, error or DriveConnectionError("fake", f"{call} fails")
        self.left, self.times = after, until

    def _fail(self, call):
        if call == self.failing:
            self.left -= 1
            if self.left < 0 and self.times > 0:
                self.times -= 1
                raise self.error

    def enable(self, mode):
        super().enable(mode)
        self._fail("enable")

    def disable(self):
        self._fail("disable")
        super().disable()

    def quick_stop(self):
        self._fail("quick_stop")
        super().quick_stop()

    def exchange(self, command):
        self._fail("exchange")
        return super().exchange(command)


@on_each
@pytest.mark.parametrize(
    ("call", "after"), [("enable", 0), ("exchange", 0), ("exchange", 5), ("disable", 0), ("quick_stop", 0)]
)
@pytest.mark.parametrize("error", [DriveConnectionError("fake", "no answer"), RuntimeError("bug"), KeyboardInterrupt()])
def test_a_drive_that_raises_in_any_call_ends_in_power_off(setup, call, after, error):
    stop = StopRequest()
    drive = Failing(call, error, after, until=2)
    drive.before = lambda cycle: stop.ask("enough") if cycle > 10 else None
    assert run(setup, drive, push(setup, 1000), stop).outcome.outcome in ("failed", "stopped")


class Braking(FakeDrive):
    """Goes on braking for some exchanges after its quick stop; raises in one of them where it is to."""

    def __init__(self, exchanges, fails_at=None, error=None):
        super().__init__()
        self._left, self._fails_at, self._error = exchanges, fails_at, error

    def exchange(self, command):
        if "quick_stop" not in self.calls or self._left <= 0:
            return super().exchange(command)
        self._left -= 1
        if self._left == self._fails_at:
            raise self._error
        return super().exchange(command)._replace(status=Status.QUICK_STOP)


def tripping(drive):
    """The drive, its speed too high from the tenth cycle on."""
    drive.alter = lambda cycle, sample: sample._replace(velocity_rad_s=9.0) if cycle >= 10 else sample
    return drive


@on_each
def test_the_braking_is_recorded_until_every_joint_stands(setup):
    ran = run(setup, tripping(Braking(7)), push(setup, 1000), other=lambda: Braking(4))
    assert ran.outcome.outcome == "tripped"
    assert len(ran.rows["time_s"]) == 10 + 8
    assert ran.sink.events[-1][1] == "end"


@on_each
def test_an_interrupt_while_it_brakes_ends_in_power_off_at_once(setup):
    drive = tripping(Braking(50, fails_at=46, error=KeyboardInterrupt()))
    ran = run(setup, drive, push(setup, 1000), other=lambda: Braking(50))
    assert ran.outcome.outcome == "tripped"
    assert ran.outcome.reason.endswith("quick stop failed: KeyboardInterrupt")
    assert len(ran.rows["time_s"]) == 10 + 3


@on_each
def test_a_drive_that_does_not_answer_while_it_brakes_keeps_no_other_one_from_braking(setup):
    drive = tripping(Braking(10, fails_at=6, error=DriveConnectionError("fake", "no answer")))
    ran = run(setup, drive, push(setup, 1000), other=lambda: Braking(10))
    assert ran.outcome.outcome == "tripped"
    assert f"{setup.prefix}quick stop failed: drive 'fake': no answer" in ran.outcome.reason
    if setup.other:
        other = ran.drives[setup.other]
        assert other.commands[-11:] == [OFF] * 11  # braked to the end, though the first one was silent once
