"""A master and a slave in the control loop: action, reading and row of a cycle, by those of the two joints."""

from collections.abc import Callable
from typing import Any

from bench.config.channels import PAIR_CHANNELS, PAIR_RECORDED
from bench.control.cycle import OFF, VALUES, Action, PairAction, PairReading, Reach, Row, Truth, row_reader, values_of
from bench.control.joint import ControlledJoint

PAIR_VALUES = (
    *VALUES,
    *(f"master.{name}" for name in VALUES),
    "pair.reflected_n_m",
    *(f"pair.{one}" for one in Truth._fields),
)
"""What a cycle of a pair can be asked for; the slave's without a prefix."""

_row: Callable[[tuple[Any, ...]], Row] = row_reader(PAIR_CHANNELS, PAIR_VALUES)


def _free(_reach: Reach) -> None:
    """The operator does as he likes."""


class JointPair:
    """A master and a slave. The master is first: what the operator feels is as new as can be.

    Args:
        slave, master: the joints.
        truth: what acts on the arms, where that is known.
        operate: tells the operator of a simulated master what to do.
    """

    channels, off = PAIR_RECORDED, PairAction(Action(OFF), Action(OFF))

    def __init__(
        self,
        slave: ControlledJoint,
        master: ControlledJoint,
        truth: Callable[[], Truth] = Truth,
        operate: Callable[[Reach], None] = _free,
    ) -> None:
        self.joints = (master, slave)
        self._slave, self._master = slave, master
        self._truth, self._operate = truth, operate

    def assign(self, action: PairAction) -> None:
        """Tell the operator what he does, and each joint its action."""
        if action.reach is not None:
            self._operate(action.reach)
        self._slave.action, self._master.action = action.slave, action.master

    def reading(self) -> PairReading:
        """Both readings, and what acts on the arms."""
        return PairReading(self._slave.reading, self._master.reading, self._truth())

    def held(self) -> PairAction:
        """What both do by themselves."""
        return PairAction(self._slave.action, self._master.action)

    def row(self, action: PairAction, reading: PairReading) -> Row:
        """In the order of `bench.config.channels.PAIR_RECORDED`; its time is the slave's."""
        slave, master = values_of(action.slave, reading.slave), values_of(action.master, reading.master)
        return _row((*slave, *master, action.reflected_n_m, *reading.truth))
