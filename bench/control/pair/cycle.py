"""What one control cycle of a master-slave pair is made of: the action, the reading that answers it, the row."""

from collections.abc import Generator
from math import nan
from typing import Any, NamedTuple

from bench.control.cycle import RECORDED, Action, Reading, row_of

MASTER_RECORDED: tuple[str, ...] = (
    "master_position_rad",
    "master_velocity_rad_s",
    "master_duty",
    "master_current_a",
    "master_current_estimate_a",
    "master_current_command_a",
    "master_supply_v",
    "master_temperature_c",
    "master_enabled",
    "master_age_s",
)
PAIR_RECORDED: tuple[str, ...] = (*RECORDED, *MASTER_RECORDED, "reflected_n_m", "interaction_n_m", "hand_n_m")
"""The channels of a row, in order: the slave's as ever, the master's, what passes between them, and what truly acts."""

_OF_MASTER = [RECORDED.index(name.removeprefix("master_")) for name in MASTER_RECORDED]


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


PairProcedure = Generator[PairAction, PairReading, dict[str, Any]]
"""Yields actions, receives readings, returns the trial's results: JSON-able, units in the names."""


def pair_row(
    action: PairAction, reading: PairReading, slave_estimate_a: float, master_estimate_a: float
) -> tuple[float, ...]:
    """The row of a cycle, in the order of `PAIR_RECORDED`; its time is the slave's."""
    master = row_of(action.master, reading.master, master_estimate_a)
    return (
        *row_of(action.slave, reading.slave, slave_estimate_a),
        *(master[column] for column in _OF_MASTER),
        action.reflected_n_m,
        *reading.truth,
    )
