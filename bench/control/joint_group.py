"""The joints that one control loop moves together, and what a cycle of them is made of."""

from collections.abc import Sequence
from typing import Protocol, TypeVar

from bench.config.channels import RECORDED
from bench.control.cycle import OFF, Action, Reading, Row, row_of
from bench.control.joint import ControlledJoint

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
