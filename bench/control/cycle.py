"""What one control cycle of a joint or a pair is made of: a procedure's action, the reading that answers, the row.

A channel that is made of samples is a field of `Reading`, what `reading_of` fills it with, and a line of the table.
"""

from collections.abc import Callable, Generator, Sequence
from math import nan
from operator import itemgetter
from typing import Any, NamedTuple

from bench.config.channels import JOINT_CHANNELS, Channel
from bench.json_types import Value
from drivers.contract import Command, Mode, Sample, Status

OFF = Command(Mode.OFF)
_CURRENT, _ENABLED = Mode.CURRENT, Status.ENABLED  # at hand: Python 3.11 takes 0.1 us to find a member of an Enum
Row = tuple[float, ...]
Estimate = Callable[[Sample, float], float]


class Reading(NamedTuple):
    """What a procedure receives each cycle: `reading_of` fills it, by place.

    Attributes:
        time_s: since the start of the trial, from the drive's own stamps [s].
        sample: as the drive gave it; where it tells a torque and no current, with that over the constant.
        velocity_rad_s: the drive's, or derived where the drive has none [rad/s].
        current_a: measured where the drive measures it, else eq. (3) [A].
        current_estimate_a: by eq. (3), NaN where that is not known [A].
    """

    time_s: float
    sample: Sample
    velocity_rad_s: float
    current_a: float
    current_estimate_a: float = nan


NOTHING = Reading(0.0, Sample(nan, nan, nan, nan, nan, nan, nan, nan, Status.DISABLED), 0.0, nan)
"""Before the first."""


def reading_of(
    sample: Sample, previous: Reading, origin_s: float, estimate: Estimate | None, torque_constant_n_m_a: float
) -> Reading:
    """Make the reading of a sample.

    Args:
        sample: as the drive gave it.
        previous: the reading before.
        origin_s: the drive's stamp at the start of the trial [s].
        estimate: eq. (3), of the sample and the speed; None where the rig does not say enough.
        torque_constant_n_m_a: of the motor [N m/A]; NaN where it is not known.
    """
    time_s, _, _, velocity_rad_s, _, current_a = sample[:6]
    torque_n_m = sample[11]
    if velocity_rad_s != velocity_rad_s:  # NaN
        velocity_rad_s = _derived_velocity(sample, previous)
    estimate_a = nan if estimate is None else estimate(sample, velocity_rad_s)
    if current_a != current_a:  # NaN
        current_a = estimate_a
        if torque_n_m == torque_n_m:  # an actuator that makes a torque of its current before it tells it
            current_a = torque_n_m / torque_constant_n_m_a
            sample = sample._replace(current_a=current_a)
    return Reading(time_s - origin_s, sample, velocity_rad_s, current_a, estimate_a)


def _derived_velocity(sample: Sample, reading: Reading) -> float:
    """By the sample before; as it was where no time has passed, and 0 at the first."""
    previous, velocity_rad_s = reading[1:3]
    elapsed_s = sample.time_s - previous.time_s
    if not elapsed_s > 0.0:  # NaN, too
        return velocity_rad_s
    return (sample.position_rad - previous.position_rad) / elapsed_s


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


Procedure = Generator[Action, Reading, dict[str, Value]]
"""Yields actions, receives readings, returns the trial's results: JSON-able, units in the names."""

VALUES = (
    *(f"action.{name}" for name in Action._fields),
    *(f"reading.{name}" for name in Reading._fields),
    *(f"sample.{name}" for name in Sample._fields),
    "command.current_a",
    "sample.enabled",
)
"""What a cycle of a joint can be asked for, in the order of `values_of`."""


def values_of(action: Action, reading: Reading) -> tuple[Any, ...]:
    """All values of a cycle, in the order of `VALUES`."""
    sample = reading[1]
    mode, value, _ = action[0]
    return action + reading + sample + (value if mode is _CURRENT else nan, 1.0 if sample[8] is _ENABLED else 0.0)


def row_reader(channels: Sequence[Channel], values: Sequence[str]) -> Callable[[tuple[Any, ...]], Row]:
    """What takes the row of some channels out of the values of a cycle.

    Raises:
        ValueError: a channel reads what is not among them.
    """
    unknown = [f"{channel.name} reads '{channel.read}'" for channel in channels if channel.read not in values]
    if unknown:
        raise ValueError(f"{'; '.join(unknown)}; known are {', '.join(values)}")
    return itemgetter(*(values.index(channel.read) for channel in channels))


_row: Callable[[tuple[Any, ...]], Row] = row_reader(JOINT_CHANNELS, VALUES)


def row_of(action: Action, reading: Reading) -> Row:
    """The row of a cycle, in the order of `bench.config.channels.RECORDED`."""
    return _row(values_of(action, reading))


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
"""As `Procedure`, of both joints."""
