"""An actuator's reading as a sample of its joint."""

from math import isnan
from time import perf_counter

from drivers.actuator.reading import Reading
from drivers.contract import Ages, Sample, Status
from drivers.joint import JointScale


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
