"""What one control cycle is made of: the procedure's action, the reading that answers it, the row that is kept."""

from collections.abc import Generator
from math import nan
from typing import Any, NamedTuple

from drivers.contract import Command, Mode, Sample, Status

RECORDED: tuple[str, ...] = (
    "time_s",
    "target_rad",
    "position_rad",
    "velocity_rad_s",
    "duty",
    "current_a",
    "current_estimate_a",
    "current_command_a",
    "current_load_a",
    "current_load_half_width_a",
    "supply_v",
    "temperature_c",
    "enabled",
    "age_s",
)
"""The channels of a row, in order; all from `compensator.lab.recordings.channels`."""

OFF = Command(Mode.OFF)
_CURRENT, _ENABLED = Mode.CURRENT, Status.ENABLED  # at hand: Python 3.11 takes 0.1 us to find a member of an Enum


class Reading(NamedTuple):
    """What a procedure receives each cycle.

    Attributes:
        time_s: since the start of the trial, from the drive's own stamps [s].
        sample: as the drive gave it.
        velocity_rad_s: the drive's, or derived where the drive has none [rad/s].
        current_a: measured where the drive measures it, else eq. (3) [A].
    """

    time_s: float
    sample: Sample
    velocity_rad_s: float
    current_a: float


class Action(NamedTuple):
    """What a procedure yields each cycle.

    Attributes:
        command: to the drive. Mode.CURRENT works on every drive.
        target_rad: position set point [rad], recorded and compared with the tracking limit.
        current_load_a: friction-compensated current [A], recorded.
        event: (name, detail), recorded.
        current_load_half_width_a: half of the 95 % interval of that current [A], recorded; NaN where it is not known.
    """

    command: Command
    target_rad: float = nan
    current_load_a: float = nan
    event: tuple[str, str] | None = None
    current_load_half_width_a: float = nan


Procedure = Generator[Action, Reading, dict[str, Any]]
"""Yields actions, receives readings, returns the trial's results: JSON-able, units in the names."""


def row_of(action: Action, reading: Reading, estimate_a: float) -> tuple[float, ...]:
    """The row of a cycle, in the order of `RECORDED`."""
    # unpacked: a tenth of the time that it takes to ask for each by its name
    (mode, value, _), target_rad, current_load_a, _, half_width_a = action
    time_s, sample, velocity_rad_s, _ = reading
    _, age_s, position_rad, _, duty, current_a, supply_v, temperature_c, status, _, _ = sample
    return (
        time_s,
        target_rad,
        position_rad,
        velocity_rad_s,
        duty,
        current_a,
        estimate_a,
        value if mode is _CURRENT else nan,
        current_load_a,
        half_width_a,
        supply_v,
        temperature_c,
        1.0 if status is _ENABLED else 0.0,
        age_s,
    )
