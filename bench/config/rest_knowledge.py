"""What known loads told of the joint at rest, as part of a bench configuration."""

from typing import Annotated

from pydantic import Field

from bench.config.quantities import quantity
from bench.config.rig import Section
from compensator.rest.rest_calibration import RestCalibration

Row = Annotated[tuple[float, ...], Field(min_length=3, max_length=3)]


class RestSettings(Section):
    """Corrections of eqs (9), (10); see `compensator.rest.rest_calibration`."""

    gain: float = quantity(1.0, "", "a: what eq. (9) gives for a load, over the load", gt=0)
    step_a: float = quantity(0.0, "A", "c: what eq. (9) gives too much under any load")
    asymmetry: float = quantity(0.0, "", "r: friction forwards is 1 + r times, backwards 1 - r times its mean")
    covariance: Annotated[tuple[Row, ...], Field(min_length=3, max_length=3)] = Field(
        default=((0.0,) * 3,) * 3, description="Of gain, step_a and asymmetry"
    )
    slope: float = quantity(0.0, "", "b: what eq. (10) grows by with the current of the load")
    offset_a: float = quantity(0.0, "A", "e: what eq. (10) gives too much under any load")
    offset_sd_a: float = quantity(0.0, "A", "Standard deviation of offset_a", ge=0)
    delay: Row = Field(default=(0.0, 0.0, 0.0), description="k0, k1, k2: what a ramp gains before motion is seen")
    floor_a: float = quantity(1e-6, "A", "Least scatter of one breakaway", gt=0)
    scatter: float = quantity(0.0, "", "Scatter of one breakaway, as a share of friction", ge=0)
    moment_scatter: float = quantity(0.0, "", "The same, as a share of friction with what a moment adds", ge=0)

    def calibration(self) -> RestCalibration:
        """For the compensator."""
        return RestCalibration(**self.model_dump())
