"""What pushes tell of a joint and its motor: sign of the demand, friction, inertia, R, Ke, sag of the supply, lag."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan, nan
from typing import NamedTuple

import numpy as np

from bench.control.cycle import Reading
from bench.errors import ExperimentError
from bench.experiments.analysis.commissioning_checks import Push, column
from compensator.errors import CalibrationError
from compensator.lab.recordings.recording import FloatArray
from compensator.line_fit import Interval, fit_line
from compensator.motion.push_identification import JointModel, Motion, identify

LEAST_SHARE = 0.1  # of the voltage that the back-EMF must make up to be told from the resistance's
LEAST_SAG_STEPS = 2.0  # of what the supply scatters at rest, that it must fall by to be seen
FLOWS_SHARE = 0.5  # of the current by eq. (3), that the sensor has to show
MOVED_STEPS = 4.0  # of the position sensor: the joint has let go


class Electrics(NamedTuple):
    """The motor and its supply, with 95 % intervals; NaN with a note where they do not show.

    Attributes:
        resistance_ohm: of the winding.
        back_emf_v_s_rad: voltage per speed of the joint, which is the motor's constant times the gear ratio.
        supply_ohm: what the supply sags by, per current that the stage draws from it.
    """

    resistance_ohm: Interval
    back_emf_v_s_rad: Interval
    supply_ohm: Interval


@dataclass(frozen=True, slots=True)
class Identified:
    """What pushes tell.

    Attributes:
        demand_sign: 1 where a positive demand turns the joint to positive angles, by its count, else -1.
        current_sign: 1 where the measured current has the sign of the demand, else -1; 0 where none is measured.
        breakaway_a: current at which the joint lets go, mean of all pushes.
        joint: inertia, friction and gravity.
        electrics: of the motor and the supply.
        velocity_lag_s: by which the drive's velocity is late; NaN where the drive has none.
    """

    demand_sign: int
    current_sign: int
    breakaway_a: float
    joint: JointModel
    electrics: Electrics
    velocity_lag_s: float


def identified(pushes: Sequence[Push], count_rad: float, by_duty: bool) -> Identified:
    """What pushes both ways tell.

    Args:
        pushes: both ways, several.
        count_rad: joint angle of an encoder count [rad].
        by_duty: a duty was demanded, no current.

    Raises:
        ExperimentError: the pushes contradict each other, or tell too little; with what may be wrong.
    """
    demand_sign = _demand_sign(pushes)
    current_sign = _current_sign(pushes)
    electrics = _electrics([one for push in pushes for one in push.driven], demand_sign, current_sign)
    known = electrics if by_duty else None
    motions = [motion for push in pushes for motion in _motions(push, demand_sign, current_sign, known)]
    try:
        joint = identify(motions)
    except CalibrationError as error:
        raise ExperimentError(str(error)) from error
    breakaways_a = [_breakaway_a(push, count_rad) for push in pushes]
    return Identified(
        demand_sign, current_sign, float(np.mean(breakaways_a)), joint, electrics,
        _lag_s([reading for push in pushes for reading in (*push.driven, *push.coasting)]),
    )  # fmt: skip


def _demand_sign(pushes: Sequence[Push]) -> int:
    signs = {1 if push.travel_rad * push.direction > 0.0 else -1 for push in pushes}
    if len(signs) == 1:
        return signs.pop()
    travelled = ", ".join(f"{push.travel_rad:+.3g} rad on sign {push.direction:+d}" for push in pushes)
    raise ExperimentError(
        f"the joint does not turn as it is pushed: {travelled}. Does something else move it, an arm that falls, or "
        "does the encoder count one way only (one of its two lines is broken)?"
    )


def _current_sign(pushes: Sequence[Push]) -> int:
    """The measured current against the demand; a current by eq. (3) has its sign."""
    means_a = [float(np.mean([reading.sample.current_a for reading in push.driven])) for push in pushes]
    if np.isnan(means_a).any():
        return 0
    signs = {1 if mean_a * push.direction > 0.0 else -1 for mean_a, push in zip(means_a, pushes, strict=True)}
    if len(signs) == 1:
        return signs.pop()
    found = ", ".join(
        f"{mean_a:+.3g} A on sign {push.direction:+d}" for mean_a, push in zip(means_a, pushes, strict=True)
    )
    raise ExperimentError(
        f"the measured current does not change its sign with the demand: {found}. Where the drive measures a "
        "magnitude, say so in its settings"
    )


def _motions(push: Push, demand_sign: int, current_sign: int, electrics: Electrics | None) -> list[Motion]:
    """Driven and coasting, the current towards positive angles."""
    sign = demand_sign * (current_sign or 1)
    return [
        Motion(_times(part), _positions(part), sign * _current_a(part, sign, electrics))
        for part in (push.driven, push.coasting)
    ]


def _current_a(part: Sequence[Reading], sign: int, electrics: Electrics | None) -> FloatArray:
    """The current of each reading: as measured; of a demanded duty by eq. (3), which is finer than most sensors.

    A stage with a duty of 0 shorts the motor, which brakes, or lets no current flow; the sensor tells which.
    """
    measured_a: FloatArray = np.nan_to_num(np.array([one.current_a for one in part]))
    if electrics is None or isnan(electrics.resistance_ohm.value):
        return measured_a
    duty, supply_v = column(part, "duty"), column(part, "supply_v")
    back_emf_v = electrics.back_emf_v_s_rad.value * sign * np.array([one.velocity_rad_s for one in part])
    found_a = np.asarray((duty * supply_v - back_emf_v) / electrics.resistance_ohm.value)
    off = duty == 0.0
    if float(measured_a[off] @ found_a[off]) < FLOWS_SHARE * float(found_a[off] @ found_a[off]):
        found_a[off] = 0.0
    return found_a


def _breakaway_a(push: Push, count_rad: float) -> float:
    """Current when the joint lets go."""
    moved = np.abs(_positions(push.driven) - push.driven[0].sample.position_rad) > MOVED_STEPS * count_rad
    return abs(push.driven[int(np.argmax(moved))].current_a)


def _electrics(driven: Sequence[Reading], demand_sign: int, current_sign: int) -> Electrics:
    """i = (V d - Ke N v) / R, and V = V0 - Rs d i, over all driven readings."""
    duty, supply_v, current_a = (column(driven, name) for name in ("duty", "supply_v", "current_a"))
    if not (np.isfinite(duty).all() and np.isfinite(supply_v).all() and np.isfinite(current_a).all()):
        unseen = Interval(nan, note="the drive does not measure duty, supply and current")
        return Electrics(unseen, unseen, unseen)
    current_a = current_sign * current_a
    speed_rad_s = demand_sign * np.array([reading.velocity_rad_s for reading in driven])
    # the current is what is coarse: it is the response, so that its steps do not bias R
    line = fit_line(np.column_stack([duty * supply_v, speed_rad_s]), current_a)
    back_emf = line.ratio(1)
    if np.max(np.abs(back_emf.value * speed_rad_s)) < LEAST_SHARE * np.max(np.abs(duty * supply_v)):
        back_emf = back_emf._replace(note="hardly shows: the joint did not get fast")
    return Electrics(line.inverse(), back_emf, _sag(duty * current_a, supply_v))


def _sag(drawn_a: FloatArray, supply_v: FloatArray) -> Interval:
    line = fit_line(np.column_stack([-drawn_a, np.ones_like(drawn_a)]), supply_v)
    found = line.coefficient(0)
    if abs(found.value) * np.ptp(drawn_a) < LEAST_SAG_STEPS * line.residual or np.ptp(supply_v) == 0.0:
        return found._replace(note="does not show: the pushes draw too little")
    return found


def _lag_s(readings: Sequence[Reading]) -> float:
    """Time constant of a first-order lag between the slope of the position and the drive's velocity."""
    velocity_rad_s = column(readings, "velocity_rad_s")
    if np.isnan(velocity_rad_s).any():
        return nan
    time_s, position_rad = _times(readings), _positions(readings)
    inner = slice(1, -1)
    elapsed_s = time_s[2:] - time_s[:-2]
    good = (elapsed_s > 0.0) & (elapsed_s < 3.0 * np.median(elapsed_s))
    slope = ((position_rad[2:] - position_rad[:-2])[good]) / elapsed_s[good]
    rate = ((velocity_rad_s[2:] - velocity_rad_s[:-2])[good]) / elapsed_s[good]
    square = float(rate @ rate)
    return max(float(rate @ (slope - velocity_rad_s[inner][good])) / square, 0.0) if square > 0.0 else 0.0


def _times(readings: Sequence[Reading]) -> FloatArray:
    return np.array([reading.time_s for reading in readings])


def _positions(readings: Sequence[Reading]) -> FloatArray:
    return np.array([reading.sample.position_rad for reading in readings])
