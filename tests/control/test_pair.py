"""A master and a slave in one loop: both commanded and recorded in each cycle, and the operator told what to do.

That whatever one of them does takes both off is in `test_loop.py`.
"""

from math import nan

import numpy as np

from bench.config.channels import PAIR_RECORDED
from bench.config.sections import Limits
from bench.control.clock import VirtualClock
from bench.control.cycle import OFF, Action, PairAction, Reach, Truth
from bench.control.ending import StopRequest
from bench.control.joint import ControlledJoint
from bench.control.limits import Guard
from bench.control.loop import ControlLoop
from bench.control.pairs.pair import JointPair
from bench.control.servo import CurrentServo
from drivers.contract import Command, Mode
from tests.control.fake_drive import RIG, FakeDrive, ListSink
from tests.control.loops import PERIOD_S

PUSH = PairAction(
    Action(Command(Mode.CURRENT, 0.1), target_rad=0.0), Action(Command(Mode.CURRENT, -0.05)), reflected_n_m=0.3
)


def push(cycles=20, action=PUSH):
    yield PairAction(Action(OFF), Action(OFF))
    for _ in range(cycles):
        yield action


def run(procedure, drive=FakeDrive, **pair):
    drives = {name: drive() for name in ("slave", "master")}
    for one in drives.values():
        one.open(PERIOD_S)
    joints = {name: ControlledJoint(one, Guard(Limits()), CurrentServo(RIG), name) for name, one in drives.items()}
    sink = ListSink()
    outcome = ControlLoop(JointPair(**joints, **pair), VirtualClock(), PERIOD_S).run(procedure, sink, StopRequest())
    return outcome, dict(zip(PAIR_RECORDED, np.vstack(sink.blocks).T, strict=True))


def test_both_joints_are_commanded_and_recorded_in_each_cycle():
    outcome, rows = run(push(), truth=lambda: Truth(1.5, 0.25))
    assert (outcome.outcome, outcome.cycles) == ("completed", 21)
    np.testing.assert_allclose(rows["current_command_a"], [nan] + [0.1] * 20)
    np.testing.assert_allclose(rows["master_current_command_a"], [nan] + [-0.05] * 20)
    np.testing.assert_allclose(rows["master_duty"][1:], -0.05 * 4.0 / 24.0)
    np.testing.assert_allclose(rows["reflected_n_m"], [nan] + [0.3] * 20)
    assert set(rows["interaction_n_m"]) == {1.5}
    assert set(rows["hand_n_m"]) == {0.25}


def test_the_operator_hears_when_to_reach():
    heard = []
    run(push(3, PUSH._replace(reach=Reach(0.5, 1.0))), operate=heard.append)
    assert heard == [Reach(0.5, 1.0)] * 3


def test_both_joints_are_switched_on_before_either_is_sent_a_command():
    calls = []

    class Noted(FakeDrive):
        def enable(self, mode):
            calls.append("enable")
            super().enable(mode)

        def exchange(self, command):
            calls.append(command.mode)
            return super().exchange(command)

    run(push(1), Noted)
    assert calls[-4:] == ["enable", "enable", Mode.DUTY, Mode.DUTY]
