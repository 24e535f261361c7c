"""The `[limits]` section: what the bench never exceeds."""

from pydantic import model_validator

from bench.config.quantities import quantity
from bench.config.rig import Section


class Limits(Section):
    """What the bench never exceeds. Compared with every sample, before motion and during it."""

    position_min_rad: float = quantity(-2.2, "rad", "Lowest joint angle")
    position_max_rad: float = quantity(2.2, "rad", "Highest joint angle")
    speed_rad_s: float = quantity(8.0, "rad/s", "Highest joint speed, either way", gt=0)
    current_a: float = quantity(2.0, "A", "Highest motor current, either way", gt=0)
    temperature_c: float = quantity(80.0, "degC", "Highest drive temperature", gt=0)
    tracking_error_rad: float = quantity(0.5, "rad", "Largest position error", gt=0)
    sample_age_s: float = quantity(0.1, "s", "Oldest sample that still counts", gt=0)
    slow_sample_age_s: float = quantity(
        2.0, "s", "Oldest supply voltage, temperature or state of the drive that still counts", gt=0
    )
    load_kg: float = quantity(0.1, "kg", "Heaviest load on the arm", ge=0)

    @model_validator(mode="after")
    def _check_order(self) -> "Limits":
        if not self.position_min_rad < self.position_max_rad:
            raise ValueError(f"position_min_rad must be below position_max_rad, {self.position_max_rad} rad")
        return self

    def position_range(self) -> str:
        """The allowed positions, in words."""
        return f"{self.position_min_rad:g} .. {self.position_max_rad:g}"
