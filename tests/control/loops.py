"""The control loop of one joint and of a pair on fake drives: the same test runs on each."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from bench.config.channels import PAIR_RECORDED, RECORDED
from bench.config.rig import Rig
from bench.config.sections import Limits
from bench.control.clock import Clock, VirtualClock
from bench.control.cycle import OFF, Action, PairAction, Reading
from bench.control.ending import Outcome, StopRequest
from bench.control.joint import ControlledJoint
from bench.control.joint_group import SingleJoint
from bench.control.limits import Guard
from bench.control.loop import ControlLoop
from bench.control.pairs.pair import JointPair
from bench.control.servo import CurrentServo
from drivers.contract import Command, Mode
from tests.control.fake_drive import RIG, FakeDrive, ListSink

PERIOD_S = 0.005
PUSH = Action(Command(Mode.CURRENT, 0.1), target_rad=0.0)


@dataclass(frozen=True)
class Setup:
    """A loop of one joint or two; what a test does, it does to one of them.

    Attributes:
        name: of that joint; "" where there is one only.
        other: name of the other one.
        channels: of the rows.
    """

    name: str
    other: str
    channels: tuple[str, ...]

    @property
    def prefix(self) -> str:
        """What a message of that joint begins with."""
        return f"{self.name}: " if self.name else ""

    def channel(self, name: str) -> str:
        """That joint's channel of a name."""
        return f"master_{name}" if self.name == "master" else name

    def action(self, action: Action) -> Any:
        """The same for each joint."""
        return PairAction(action, action) if self.other else action

    def reading(self, reading: Any) -> Reading:
        """Of that joint."""
        found: Reading = getattr(reading, self.name) if self.other else reading
        return found

    def loop(
        self, drives: dict[str, Any], limits: Limits | None, rig: Rig | None, clock: Clock, period_s: float = PERIOD_S
    ) -> ControlLoop[Any, Any]:
        """On open drives; the rig is that of the joint."""
        joints = {}
        for name, drive in drives.items():
            servo = None if name == self.name and rig is None else CurrentServo(rig or RIG)
            joints[name] = ControlledJoint(drive, Guard(limits or Limits()), servo, name)
        return ControlLoop(JointPair(**joints) if self.other else SingleJoint(joints[""]), clock, period_s)


SETUPS = (Setup("", "", RECORDED), Setup("slave", "master", PAIR_RECORDED), Setup("master", "slave", PAIR_RECORDED))
on_each = pytest.mark.parametrize("setup", SETUPS, ids=["one joint", "slave of a pair", "master of a pair"])


@dataclass
class Ran:
    """A run that has ended.

    Attributes:
        setup: what it ran on.
        drives: by the joint's name.
        rows: by the name of the channel.
    """

    setup: Setup
    outcome: Outcome
    sink: ListSink
    drives: dict[str, Any]

    @property
    def rows(self) -> dict[str, Any]:
        return dict(zip(self.setup.channels, np.vstack(self.sink.blocks).T, strict=True))

    def channel(self, name: str) -> Any:
        """Of the joint of the test."""
        return self.rows[self.setup.channel(name)]


def push(setup: Setup, cycles: int = 20, action: Action = PUSH) -> Any:
    """A procedure that does one thing again and again, after a cycle without power."""
    reading = yield setup.action(Action(OFF))
    for _ in range(cycles):
        reading = yield setup.action(action)
    return {"last_position_rad": setup.reading(reading).sample.position_rad}


class StillPowered(AssertionError):
    """Raised when a drive was left with its power stage on.

    Attributes:
        names: of the joints.
        outcome: of the run.
    """

    def __init__(self, names: list[str], outcome: Outcome) -> None:
        super().__init__(f"still powered: {names}; the run: {outcome}")
        self.names, self.outcome = names, outcome


def run(
    setup: Setup,
    drive: Any,
    procedure: Any,
    stop: StopRequest | None = None,
    sink: ListSink | None = None,
    limits: Limits | None = None,
    rig: Rig | None = RIG,
    clock: Clock | None = None,
    other: Callable[[], FakeDrive] = FakeDrive,
) -> Ran:
    """Run a procedure; whatever it does, every drive is off afterwards.

    `drive` is that of the joint of the test, `other` makes that of the other one. Raises `StillPowered` where one is
    left with power.
    """
    drives = {setup.name: drive} | ({setup.other: other()} if setup.other else {})
    sink = sink or ListSink()
    for one in drives.values():
        one.open(PERIOD_S)
    loop = setup.loop(drives, limits, rig, clock or VirtualClock())
    outcome = Outcome("running")
    try:
        outcome = loop.run(procedure, sink, stop or StopRequest())
    finally:
        written = {name: [call for call in one.calls if call != "inspect"] for name, one in drives.items()}
        powered = [name for name, one in drives.items() if one.powered or written[name][-1] != "disable"]
        if powered:
            raise StillPowered(powered, outcome)
    return Ran(setup, outcome, sink, drives)
