"""From the table of a speed sweep to the points of its friction curves, and to the constants of its motor."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import nan
from typing import Any

from compensator.errors import CalibrationError
from compensator.motor import identification as motor_identification
from compensator.motor.identification import MotorIdentification, MotorSample

SIGNS = {"forward": 1.0, "backward": -1.0}
Row = Mapping[str, Any]
"""One row of the summary of a speed sweep: conditions and results of a trial; with `trial_id` where it is kept."""


@dataclass(frozen=True, slots=True)
class FrictionPoint:
    """Means over one window of steady, or nearly steady, motion of the balanced joint.

    Attributes:
        load_kg: hung on the arm, balanced.
        speed_rad_s, acceleration_rad_s2: of the motor shaft; signs say the direction.
        current_a, duty: of the motor; their signs go with the speed's.
        trial_id: of the trial that shows it; None where it is not from a store.
    """

    load_kg: float
    speed_rad_s: float
    acceleration_rad_s2: float
    current_a: float
    duty: float
    trial_id: int | None = None


def friction_points(rows: Iterable[Row]) -> dict[float, list[FrictionPoint]]:
    """The points at each load [kg], from the lightest on.

    Every stroke that was steady, or gained speed with its teeth in contact, gives one.

    Raises:
        CalibrationError: there is none at all.
    """
    points: dict[float, list[FrictionPoint]] = defaultdict(list)
    strokes = list(rows)
    if not strokes:
        raise CalibrationError(
            "there are 0 trials of the balanced arm in motion, from which a friction curve is told; name a speed "
            "sweep, too, or an import of such trials"
        )
    for row in strokes:
        points[float(row["load_kg"])] += _points_of(row)
    if not any(points.values()):
        raise CalibrationError(
            f"0 of {len(strokes)} strokes of the speed sweep came to a steady speed; the results of each trial say "
            "under 'ending' why"
        )
    return dict(sorted(points.items()))


def sign_of(row: Row) -> float:
    """1 forward, -1 backward."""
    return SIGNS[row["direction"]]


def _points_of(row: Row) -> list[FrictionPoint]:
    sign = sign_of(row)
    windows = row.get("windows")
    if windows is None:  # recorded before every stroke was kept
        windows = [{**row, "motor_acceleration_rad_s2": 0.0, "usable": row["saturated"]}]
    return [
        FrictionPoint(
            load_kg=float(row["load_kg"]),
            speed_rad_s=sign * one["motor_speed_rad_s"],
            acceleration_rad_s2=sign * one["motor_acceleration_rad_s2"],
            current_a=sign * one["current_a"],
            duty=sign * one["duty"],
            trial_id=row.get("trial_id"),
        )
        for one in windows
        if one["usable"]
    ]


def identify_motor(rows: Iterable[Row]) -> MotorIdentification:
    """R and Ke of the motor, as far as the sweep tells: stalled rows are locked samples, saturated ones running.

    Without a measured current only the rows of the lightest load are used, since friction differs between loads and
    would hide even R and Ke.

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
