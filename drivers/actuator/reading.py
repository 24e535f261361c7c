"""What an actuator says of itself, in its own sense of turning."""

from math import isnan, nan
from time import perf_counter
from typing import NamedTuple

from drivers.contract import Ages, Sample, Status
from drivers.joint import JointScale


class Reading(NamedTuple):
    """One answer. Signs are the actuator's own; a quantity that is not measured is NaN.

    Attributes:
        asked_s: when it was asked for, of `perf_counter` [s].
        counts: position, in counts of `rig.sensor`, without wraps.
        counts_s: speed in these [1/s].
        duty: applied PWM duty, -1 .. 1.
        current_a: motor current [A].
        torque_n_m: torque at the actuator's output [N m].
        supply_v: supply voltage [V].
        temperature_c: highest that it tells [deg C].
        is_on: whether it says that its power stage is on.
        fault: what has switched it off, in words; "" where nothing has.
        time_s: when it was measured, by the actuator's own clock, without wraps [s]; NaN: it tells none.
        slow_s: when supply and temperature were asked for [s]; NaN: with the rest.
    """

    asked_s: float
    counts: float
    counts_s: float = nan
    duty: float = nan
    current_a: float = nan
    torque_n_m: float = nan
    supply_v: float = nan
    temperature_c: float = nan
    is_on: bool = False
    fault: str = ""
    time_s: float = nan
    slow_s: float = nan


def sample_of(reading: Reading, joint: JointScale, status: Status) -> Sample:
    """A reading, seen from the joint.

    Args:
        reading: in the actuator's own sense of turning.
        joint: scales and signs.
        status: of the power stage.
    """
    now_s = perf_counter()
    age_s = now_s - reading.asked_s
    slow_s = age_s if isnan(reading.slow_s) else now_s - reading.slow_s
    return Sample(
        reading.asked_s if isnan(reading.time_s) else reading.time_s, age_s,
        joint.position_rad(reading.counts), joint.velocity_rad_s(reading.counts_s),
        joint.motor_sign * reading.duty, joint.motor_sign * reading.current_a,
        reading.supply_v, reading.temperature_c, status,
        Ages(age_s, age_s, age_s, age_s, slow_s, slow_s, age_s),
        torque_n_m=joint.motor_sign * reading.torque_n_m,
    )  # fmt: skip
