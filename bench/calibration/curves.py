"""From points to friction curves."""

from collections.abc import Mapping, Sequence

from pydantic import BaseModel, Field

from bench.calibration.points import FrictionPoint
from compensator.errors import CalibrationError
from compensator.motion.friction_calibration import FrictionFit, fit


class Estimate(BaseModel):
    """One parameter with its 95 % interval."""

    value: float | None
    low: float | None = None
    high: float | None = None
    note: str = ""


class Curve(BaseModel):
    """General Kinetic Friction of the balanced joint under one load, over the speed of the motor shaft."""

    load_kg: float
    f_load_a: float = Field(description="F_load under this load; it selects the curve")
    f_load_from: str
    coulomb_a: float
    static_a: float
    stribeck_speed_rad_s: float
    shape: float
    viscous_a_s_rad: float
    offset_a: float = Field(description="half of what friction is more forwards than backwards")
    rise_offset_a: float = Field(default=0.0, description="what that rises by towards rest")
    inertia_a_s2_rad: float = Field(description="current per acceleration of the motor shaft: motor, arm and load")
    parameters: dict[str, Estimate] = Field(description="value, low, high (95 %) and note of each, by name")
    scatter_a: float
    points: int


def friction_fits(points: Mapping[float, Sequence[FrictionPoint]], stribeck: bool = True) -> dict[float, FrictionFit]:
    """The friction curve at each load [kg], over the speed of the motor shaft.

    What a point still gains in speed takes current too: its inertia is fitted along, and is no part of the curve.

    Raises:
        CalibrationError: the points of a load cannot carry a curve; the load is named.
    """
    return {load_kg: _fit(load_kg, found, stribeck) for load_kg, found in points.items()}


def inertia_of(found: FrictionFit) -> float:
    """Current that an acceleration of the motor shaft takes [A s2/rad], as the points of the curve told; 0 if not."""
    fitted = found.parameters.get("inertia_a_s2_rad")
    return 0.0 if fitted is None else fitted.value


def rise_offset_of(found: FrictionFit) -> float:
    """What the difference between the directions rises by towards rest [A]; 0 where the points did not tell."""
    fitted = found.parameters.get("rise_offset_a")
    return 0.0 if fitted is None else fitted.value


def _fit(load_kg: float, points: Sequence[FrictionPoint], stribeck: bool) -> FrictionFit:
    try:
        return fit(
            [one.speed_rad_s for one in points],
            [one.current_a for one in points],
            stribeck,
            [one.acceleration_rad_s2 for one in points],
        )
    except CalibrationError as error:
        raise CalibrationError(f"load {load_kg:g} kg: {error}") from error
