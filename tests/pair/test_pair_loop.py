"""The pair loop on fake drives: whatever one of them does, both end in power-off."""

import itertools
from math import nan

import numpy as np
import pytest

from bench.control.clock import VirtualClock
from bench.control.cycle import OFF, Action
from bench.control.limits import Guard, Limits
from bench.control.pair.cycle import PAIR_RECORDED, PairAction, Reach, Truth
from bench.control.pair.joint import PairJoint
from bench.control.pair.loop import PairLoop
from bench.control.servo import CurrentServo
from bench.control.stop_request import StopRequest
from compensator.lab.recordings.channels import CHANNELS
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConnectionError
from tests.bench.fake_drive import RIG, FakeDrive, ListSink

PERIOD_S = 0.005
PUSH = PairAction(
    Action(Command(Mode.CURRENT, 0.1), target_rad=0.0), Action(Command(Mode.CURRENT, -0.05)), reflected_n_m=0.3
)


def push(cycles=20, action=PUSH):
    yield PairAction(Action(OFF), Action(OFF))
    for _ in range(cycles):
        reading = yield action
    return {"slave_rad": reading.slave.sample.position_rad, "master_rad": reading.master.sample.position_rad}


def run(slave, master, procedure=None, stop=None, sink=None, **loop):
    sink = sink or ListSink()
    for drive in (slave, master):
        drive.open(PERIOD_S)
    joints = [
        PairJoint(name, drive, Guard(Limits()), CurrentServo(RIG))
        for name, drive in (("slave", slave), ("master", master))
    ]
    made = PairLoop(*joints, VirtualClock(), PERIOD_S, **loop)
    return made.run(procedure or push(), sink, stop or StopRequest()), sink


def rows_of(sink):
    return dict(zip(PAIR_RECORDED, np.vstack(sink.blocks).T, strict=True))


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


def test_both_joints_are_commanded_and_recorded_in_each_cycle():
    slave, master = FakeDrive(), FakeDrive()
    outcome, sink = run(slave, master, truth=lambda: Truth(1.5, 0.25))
    rows = rows_of(sink)
    assert (outcome.outcome, outcome.cycles) == ("completed", 21)
    assert (slave.powered, master.powered) == (False, False)
    np.testing.assert_allclose(rows["current_command_a"], [nan] + [0.1] * 20)
    np.testing.assert_allclose(rows["master_current_command_a"], [nan] + [-0.05] * 20)
    np.testing.assert_allclose(rows["master_duty"][1:], -0.05 * 4.0 / 24.0)
    np.testing.assert_allclose(rows["reflected_n_m"], [nan] + [0.3] * 20)
    assert set(rows["interaction_n_m"]) == {1.5}
    assert set(rows["hand_n_m"]) == {0.25}
    assert set(PAIR_RECORDED) <= set(CHANNELS)


def test_the_operator_hears_when_to_reach():
    heard = []
    action = PUSH._replace(reach=Reach(0.5, 1.0))
    run(FakeDrive(), FakeDrive(), push(3, action), operate=heard.append)
    assert heard == [Reach(0.5, 1.0)] * 3


@pytest.mark.parametrize("failing", ["slave", "master"])
@pytest.mark.parametrize(
    ("call", "after"), [("enable", 0), ("exchange", 0), ("exchange", 5), ("disable", 0), ("quick_stop", 0)]
)
@pytest.mark.parametrize("error", [DriveConnectionError("fake", "no answer"), RuntimeError("bug"), KeyboardInterrupt()])
def test_a_drive_that_raises_takes_both_off(failing, call, after, error):
    drives = {
        name: Failing(call, error, after, until=2) if name == failing else FakeDrive() for name in ("slave", "master")
    }
    stop = StopRequest()
    cycles = itertools.count()

    def stopped_late():
        if next(cycles) == 10:
            stop.ask("enough")
        return Truth()

    outcome, _ = run(**drives, stop=stop, truth=stopped_late)
    assert outcome.outcome in ("failed", "stopped")
    for drive in drives.values():
        assert not drive.powered
        assert drive.calls[-1] == "disable"


@pytest.mark.parametrize("failing", ["slave", "master"])
def test_what_cannot_be_powered_off_is_said_and_the_other_one_is_off(failing):
    drives = {name: Failing("disable") if name == failing else FakeDrive() for name in ("slave", "master")}
    drives[failing].left = 0
    outcome, _ = run(**drives)
    assert outcome.outcome == "failed"
    assert f"{failing}: power-off failed" in outcome.reason
    other = drives["master" if failing == "slave" else "slave"]
    assert not other.powered


@pytest.mark.parametrize("tripping", ["slave", "master"])
def test_a_limit_of_either_brakes_both(tripping):
    wild = FakeDrive(alter=lambda cycle, sample: sample._replace(velocity_rad_s=9.0) if cycle > 8 else sample)
    drives = {name: wild if name == tripping else FakeDrive() for name in ("slave", "master")}
    outcome, sink = run(**drives)
    assert outcome.outcome == "tripped"
    assert outcome.reason == f"{tripping}: speed is 9 rad/s; allowed is -8 .. 8 rad/s"
    assert sink.events[-1][1] == "end"
    for drive in drives.values():
        assert drive.calls[-2:] == ["quick_stop", "disable"]


@pytest.mark.parametrize("sick", ["slave", "master"])
def test_a_drive_in_fault_takes_both_off(sick):
    ill = FakeDrive(alter=lambda cycle, sample: sample._replace(status=Status.FAULT) if cycle > 8 else sample)
    drives = {name: ill if name == sick else FakeDrive() for name in ("slave", "master")}
    outcome, _ = run(**drives)
    assert outcome.outcome == "failed"
    assert f"{sick}: status is FAULT" in outcome.reason
    assert not any(drive.powered for drive in drives.values())


@pytest.mark.parametrize("wrong", ["slave", "master"])
def test_what_is_outside_its_limits_before_motion_refuses_the_pair(wrong):
    far = FakeDrive(alter=lambda _, sample: sample._replace(position_rad=3.0))
    drives = {name: far if name == wrong else FakeDrive() for name in ("slave", "master")}
    outcome, sink = run(**drives)
    assert outcome.outcome == "refused"
    assert outcome.reason.startswith(f"before motion: {wrong}: position is 3 rad")
    assert not sink.blocks
    assert not any("enable duty" in drive.calls for drive in drives.values())


def test_a_stop_is_honoured_within_one_cycle():
    stop = StopRequest()
    slave = FakeDrive(before=lambda cycle: stop.ask("cable is caught") if cycle == 10 else None)
    master = FakeDrive()
    outcome, _ = run(slave, master, push(1000), stop)
    assert (outcome.outcome, outcome.reason, outcome.cycles) == ("stopped", "cable is caught", 10)
    assert not slave.powered
    assert not master.powered


def test_a_procedure_that_raises_and_a_sink_that_fails_take_both_off():
    def breaks():
        yield from push(5)
        raise ValueError("no")

    for procedure, sink in ((breaks(), ListSink()), (push(1000), ListSink(fail_on_block=0))):
        slave, master = FakeDrive(), FakeDrive()
        outcome, _ = run(slave, master, procedure, sink=sink)
        assert outcome.outcome == "failed"
        assert not slave.powered
        assert not master.powered
