"""From the table of a speed sweep to the points of its friction curves."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from compensator.errors import CalibrationError

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
    for row in rows:
        points[float(row["load_kg"])] += _points_of(row)
    if not any(points.values()):
        raise CalibrationError("the sweep has 0 saturated rows; look at what each row gives as its ending")
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
