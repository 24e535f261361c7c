"""What a speed sweep tells of the motor."""

from collections.abc import Iterable
from math import nan

from bench.calibration.points import Row, sign_of
from compensator.motor import identification as motor_identification
from compensator.motor.identification import MotorIdentification, MotorSample


def identify_motor(rows: Iterable[Row]) -> MotorIdentification:
    """R and Ke of the motor, as far as the sweep tells: stalled rows are locked samples, saturated ones running.

    Without a measured current, the lightest load alone is looked at: friction that differs from row to row would not
    let even the lumps show.

    Raises:
        CalibrationError: too few rows.
    """
    usable = [row for row in rows if row["saturated"] or row["speed_rad_s"] == 0.0]
    if usable and all(row["measured_current_a"] is None for row in usable):
        lightest_kg = min(row["load_kg"] for row in usable)
        usable = [row for row in usable if row["load_kg"] == lightest_kg]
    return motor_identification.identify([_sample(row) for row in usable])


def _sample(row: Row) -> MotorSample:
    sign, current_a, supply_v = sign_of(row), row["measured_current_a"], row["supply_v"]
    return MotorSample(
        duty=sign * row["duty"],
        supply_v=nan if supply_v is None else supply_v,
        speed_rad_s=sign * row["motor_speed_rad_s"],
        current_a=nan if current_a is None else sign * current_a,
    )
