"""The joints that one control loop moves together, and what a cycle of them is made of."""

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

from bench.config.channels import RECORDED
from bench.control.cycle import OFF, Action, Reading, Row, row_of
from bench.control.joint import ControlledJoint
from drivers.contract import BusDrive

ActionT = TypeVar("ActionT")
ReadingT = TypeVar("ReadingT")


class JointGroup(Protocol[ActionT, ReadingT]):
    """The joints of a loop, and what their action, reading and row are made of."""

    @property
    def joints(self) -> Sequence[ControlledJoint]:
        """In the order in which they are sent their commands; time and events of the last one are the trial's."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Of a row, in order."""

    @property
    def off(self) -> ActionT:
        """The action that is recorded while the joints brake."""

    def assign(self, action: ActionT) -> None:
        """Give each joint its action."""

    def reading(self) -> ReadingT:
        """What the procedure is given, of the joints' readings."""

    def held(self) -> ActionT:
        """What the joints do now, by themselves, as the action of a row."""

    def row(self, action: ActionT, reading: ReadingT) -> Row:
        """In the order of `channels`."""


class SingleJoint:
    """A group of one: actions and readings are the joint's own."""

    channels, off, row = RECORDED, Action(OFF), staticmethod(row_of)

    def __init__(self, joint: ControlledJoint) -> None:
        self.joints = (joint,)
        self._joint = joint

    def assign(self, action: Action) -> None:
        """The action."""
        self._joint.action = action

    def reading(self) -> Reading:
        """The reading."""
        return self._joint.reading

    def held(self) -> Action:
        """The joint's own."""
        return self._joint.action


def exchange_of(joints: Sequence[ControlledJoint]) -> Callable[[], None]:
    """One exchange with every joint: in one go where one bus does that, else one after the other."""
    first = joints[0]
    if len(joints) == 1:
        return first.exchange
    drive = first.drive
    buses = [one.drive.bus if isinstance(one.drive, BusDrive) else None for one in joints]
    if not isinstance(drive, BusDrive) or buses[0] is None or any(bus is not buses[0] for bus in buses):
        return lambda: _in_turn(joints)

    def together() -> None:
        samples = drive.exchange_together([(joint.drive, joint.wire_command()) for joint in joints])
        for joint, sample in zip(joints, samples, strict=True):
            joint.take(sample)

    return together


def _in_turn(joints: Sequence[ControlledJoint]) -> None:
    for joint in joints:
        joint.exchange()
