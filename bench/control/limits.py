"""The limits of the bench, and the check that every cycle passes before the next command goes out."""

from collections.abc import Iterator
from typing import NamedTuple

from pydantic import model_validator

from bench.config.quantities import quantity
from bench.config.rig import Section
from bench.errors import LimitTrip, quantity_message
from drivers.contract import ALL_NEW, Sample


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


class Violation(NamedTuple):
    """One quantity outside its limits."""

    quantity: str
    found: float
    allowed: str
    unit: str


class Guard:
    """Compares samples with limits.

    Args:
        limits: what is allowed.
    """

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._bounds = (
            limits.position_min_rad,
            limits.position_max_rad,
            limits.speed_rad_s,
            limits.current_a,
            limits.temperature_c,
            limits.tracking_error_rad,
            limits.sample_age_s,
            limits.slow_sample_age_s,
        )

    def check(self, sample: Sample, velocity_rad_s: float, current_a: float, target_rad: float) -> None:
        """Compare one cycle with the limits. A quantity that is not measured (NaN) is not compared, but position is.

        Args:
            sample: as the drive gave it.
            velocity_rad_s: the joint's [rad/s].
            current_a: the motor's, measured or from eq. (3) [A].
            target_rad: position set point [rad]; NaN where there is none.

        Raises:
            LimitTrip: naming the quantity, its value, the limit and the unit.
        """
        low, high, speed, current, temperature, error, age, slow_age = self._bounds
        _, age_s, position_rad, _, _, _, _, temperature_c, _, ages, _ = sample
        # written so that NaN passes, except for the position and the age
        if (
            low <= position_rad <= high
            and not (velocity_rad_s > speed or velocity_rad_s < -speed)
            and not (current_a > current or current_a < -current)
            and not temperature_c > temperature
            and not (target_rad - position_rad > error or target_rad - position_rad < -error)
            and age_s <= age
            and (ages is ALL_NEW or _slow_age_s(sample) <= slow_age)
        ):
            return
        violation = next(self._violations(sample, velocity_rad_s, current_a, target_rad))
        raise LimitTrip(quantity_message(*violation))

    def is_stale(self, sample: Sample) -> bool:
        """Whether something in a sample is older than allowed."""
        return not sample.age_s <= self.limits.sample_age_s or _slow_age_s(sample) > self.limits.slow_sample_age_s

    def _violations(
        self, sample: Sample, velocity_rad_s: float, current_a: float, target_rad: float
    ) -> Iterator[Violation]:
        limits, position_rad = self.limits, sample.position_rad
        # a stale sample tells nothing else
        if not sample.age_s <= limits.sample_age_s:
            yield Violation("age of the sample", sample.age_s, f"at most {limits.sample_age_s:g}", "s")
        error_rad = target_rad - position_rad
        if not limits.position_min_rad <= position_rad <= limits.position_max_rad:
            yield Violation("position", position_rad, limits.position_range(), "rad")
        if abs(velocity_rad_s) > limits.speed_rad_s:
            yield Violation("speed", velocity_rad_s, _either_way(limits.speed_rad_s), "rad/s")
        if abs(current_a) > limits.current_a:
            yield Violation("motor current", current_a, _either_way(limits.current_a), "A")
        if sample.temperature_c > limits.temperature_c:
            yield Violation("temperature", sample.temperature_c, f"at most {limits.temperature_c:g}", "degC")
        if abs(error_rad) > limits.tracking_error_rad:
            yield Violation("tracking error", error_rad, _either_way(limits.tracking_error_rad), "rad")
        allowed = f"at most {limits.slow_sample_age_s:g}"
        yield Violation("age of supply voltage, temperature or state", _slow_age_s(sample), allowed, "s")


def _slow_age_s(sample: Sample) -> float:
    """Age of the oldest of what may be asked for less often than once per cycle [s]."""
    ages = sample.ages
    return max(ages.supply_s, ages.temperature_s, ages.status_s)


def _either_way(limit: float) -> str:
    return f"{-limit:g} .. {limit:g}"
