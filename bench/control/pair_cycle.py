"""What a master and a slave are told and answer in a cycle of the control loop."""

from collections.abc import Generator
from math import nan
from typing import NamedTuple

from bench.control.cycle import Action, Reading
from bench.json_types import Value


class Reach(NamedTuple):
    """What the operator at a simulated master is to do from now on; a person is free.

    Attributes:
        angle_rad: where the arm is to be in the end.
        duration_s: that he takes for it.
    """

    angle_rad: float
    duration_s: float


class Truth(NamedTuple):
    """What acts on the arms of a simulated pair; NaN of a real one.

    Attributes:
        interaction_n_m: torque that holds up the slave's load and presses its arm against a wall.
        hand_n_m: torque of the operator's hand on the master's arm.
    """

    interaction_n_m: float = nan
    hand_n_m: float = nan


class PairAction(NamedTuple):
    """What a procedure yields each cycle.

    Attributes:
        slave, master: of each joint; events are the slave's.
        reflected_n_m: load that is reflected to the operator, recorded.
        reach: what the operator does from this cycle on.
    """

    slave: Action
    master: Action
    reflected_n_m: float = nan
    reach: Reach | None = None


class PairReading(NamedTuple):
    """What a procedure receives each cycle."""

    slave: Reading
    master: Reading
    truth: Truth


PairProcedure = Generator[PairAction, PairReading, dict[str, Value]]
"""Yields actions, receives readings, returns the trial's results: JSON-able, units in the names."""
