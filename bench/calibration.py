"""From the table of a speed sweep to friction curves, their look-up, and what the sweep tells of the motor."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from math import nan
from typing import Any

from compensator import motor_identification
from compensator.errors import CalibrationError
from compensator.friction_calibration import FrictionFit, fit
from compensator.friction_lookup import FrictionLookup
from compensator.motor_identification import MotorIdentification, MotorSample

SIGNS = {"forward": 1.0, "backward": -1.0}
Row = Mapping[str, Any]
"""One row of the summary of a speed sweep: conditions and results of a trial."""


def friction_fits(rows: Iterable[Row], stribeck: bool = True) -> dict[float, FrictionFit]:
    """The friction curve at each load [kg], over the speed of the motor shaft; from the saturated rows alone.

    Raises:
        CalibrationError: the rows of a load cannot carry a curve; the load is named.
    """
    by_load: dict[float, list[Row]] = defaultdict(list)
    for row in rows:
        if row["saturated"]:
            by_load[float(row["load_kg"])].append(row)
    if not by_load:
        raise CalibrationError("the sweep has 0 saturated rows; look at what each row gives as its ending")
    fits = {}
    for load_kg, points in sorted(by_load.items()):
        speeds = [_sign(row) * row["motor_speed_rad_s"] for row in points]
        try:
            fits[load_kg] = fit(speeds, [_sign(row) * row["current_a"] for row in points], stribeck)
        except CalibrationError as error:
            raise CalibrationError(f"load {load_kg:g} kg: {error}") from error
    return fits


def friction_lookup(fits: Mapping[float, FrictionFit]) -> FrictionLookup:
    """The look-up over the load [kg].

    Raises:
        CalibrationError: there is one load only.
    """
    return FrictionLookup.over_load({load_kg: one.curve for load_kg, one in fits.items()})


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


def _sign(row: Row) -> float:
    return SIGNS[row["direction"]]


def _sample(row: Row) -> MotorSample:
    sign, current_a, supply_v = _sign(row), row["measured_current_a"], row["supply_v"]
    return MotorSample(
        duty=sign * row["duty"],
        supply_v=nan if supply_v is None else supply_v,
        speed_rad_s=sign * row["motor_speed_rad_s"],
        current_a=nan if current_a is None else sign * current_a,
    )
