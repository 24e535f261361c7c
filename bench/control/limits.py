"""The check against the limits that every cycle passes before the next command goes out."""

from collections.abc import Iterator
from typing import NamedTuple

from bench.config.channels import CHANNELS
from bench.config.sections import Limits
from bench.errors import LimitTrip, quantity_message
from drivers.contract import ALL_NEW, Sample

FRESH_SHARE = 0.5  # of the allowed age: what is nearly too old at the beginning is so before its turn to be asked comes


class Violation(NamedTuple):
    """One quantity outside its limits: what it is called, its value, what is allowed, the unit."""

    quantity: str
    found: float
    allowed: str
    unit: str

    @classmethod
    def of(cls, channel: str, found: float, allowed: str) -> "Violation":
        """By the channel that the quantity is recorded in."""
        return cls(CHANNELS[channel].label, found, allowed, CHANNELS[channel].unit)


class Guard:
    """Compares samples with limits."""

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
        age_s, position_rad = sample[1:3]
        temperature_c, _, ages = sample[7:10]
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
        """Whether something in a sample is older than allowed, or would soon be, in what is asked for seldom."""
        slow_s = FRESH_SHARE * self.limits.slow_sample_age_s
        return not sample.age_s <= self.limits.sample_age_s or _slow_age_s(sample) > slow_s

    def _violations(
        self, sample: Sample, velocity_rad_s: float, current_a: float, target_rad: float
    ) -> Iterator[Violation]:
        limits, position_rad = self.limits, sample.position_rad
        # a stale sample tells nothing else
        if not sample.age_s <= limits.sample_age_s:
            yield Violation.of("age_s", sample.age_s, f"at most {limits.sample_age_s:g}")
        error_rad = target_rad - position_rad
        if not limits.position_min_rad <= position_rad <= limits.position_max_rad:
            yield Violation.of("position_rad", position_rad, limits.position_range())
        if abs(velocity_rad_s) > limits.speed_rad_s:
            yield Violation.of("velocity_rad_s", velocity_rad_s, _either_way(limits.speed_rad_s))
        if abs(current_a) > limits.current_a:
            yield Violation.of("current_a", current_a, _either_way(limits.current_a))
        if sample.temperature_c > limits.temperature_c:
            yield Violation.of("temperature_c", sample.temperature_c, f"at most {limits.temperature_c:g}")
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
