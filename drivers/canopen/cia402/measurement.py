"""From what the TPDOs and the slow poll tell to a sample, in SI, at the joint. Pure."""

from collections.abc import Callable, Sequence
from math import copysign, isnan, nan

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.objects import POSITION, VELOCITY, DriveObject
from drivers.canopen.slow_poll import Reading
from drivers.contract import Ages, Sample, Status

Place = tuple[int, int]
"""Number of the TPDO, place in it."""


class Measurement:
    """Turns counts into samples.

    Args:
        found: scales and objects of the drive.
        place: where each object is in the TPDOs; None for one that is in none.
    """

    def __init__(self, found: Capabilities, place: Callable[[DriveObject], Place | None]) -> None:
        scale, profile = found.scale, found.profile
        position = place(POSITION)
        assert position is not None  # no drive is opened without
        self._joint = scale.joint
        self._position_place = position
        self._velocity_place = place(VELOCITY)
        self._velocity_rad_s = nan if self._velocity_place is None else scale.velocity_rad_s
        told = next((item for item in found.currents if scale.tells(item) and place(item) is not None), None)
        self._current_place = None if told is None else place(told)
        self._current_a = nan if told is None else scale.joint.motor_sign * scale.current_a(told)
        self._duty_place = None if profile.duty is None else place(profile.duty)
        self._duty_scale = nan if profile.duty is None else profile.duty.scale
        self._supply = _polled(profile.supply, found)
        self._temperature = _polled(profile.temperature, found)

    @property
    def slow(self) -> tuple[DriveObject, ...]:
        """Objects that are polled."""
        return tuple(item for item in (self._supply, self._temperature) if item is not None)

    @property
    def measured(self) -> frozenset[str]:
        """Fields of a sample that are not NaN."""
        there = {
            "position_rad": True,
            "velocity_rad_s": not isnan(self._velocity_rad_s),
            "current_a": self._current_place is not None,
            "duty": self._duty_place is not None,
            "supply_v": self._supply is not None,
            "temperature_c": self._temperature is not None,
        }
        return frozenset(name for name, present in there.items() if present)

    @property
    def resolution(self) -> dict[str, float]:
        """Smallest step of each quantity that is measured."""
        steps = {
            "position_rad": self._joint.count_rad,
            "velocity_rad_s": abs(self._velocity_rad_s),
            "current_a": abs(self._current_a),
            "duty": self._duty_scale,
            "supply_v": nan if self._supply is None else self._supply.scale,
            "temperature_c": nan if self._temperature is None else self._temperature.scale,
        }
        return {name: steps[name] for name in sorted(self.measured)}

    def sample(
        self, values: Sequence[tuple[int, ...]], slow: dict[DriveObject, Reading], status: Status, sync_s: float,
        earliest_s: float, now_s: float, number: int,
    ) -> Sample:  # fmt: skip
        """The sample of a cycle.

        Args:
            values: of each TPDO.
            slow: what the poll has.
            status: state of the power stage.
            sync_s: when the SYNC was sent at which the drive measured, as far as is known [s].
            earliest_s: when the earliest SYNC was sent at which it may have measured [s].
            now_s: the time now [s].
            number: of the SYNC.
        """
        current_a = _value(values, self._current_place) * self._current_a
        # the magnitude is all that the drive tells
        duty = copysign(_value(values, self._duty_place) * self._duty_scale, current_a)
        supply_v, supply_age_s = _slow(slow, self._supply, now_s)
        temperature_c, temperature_age_s = _slow(slow, self._temperature, now_s)
        age_s = now_s - earliest_s
        return Sample(
            sync_s,
            age_s,
            self._joint.position_rad(_value(values, self._position_place)),
            _value(values, self._velocity_place) * self._velocity_rad_s,
            duty,
            current_a,
            supply_v,
            temperature_c,
            status,
            Ages(age_s, age_s, age_s, age_s, supply_age_s, temperature_age_s, age_s),
            number,
        )


def _value(values: Sequence[tuple[int, ...]], place: Place | None) -> float:
    """What the TPDOs tell; NaN of what none does."""
    return nan if place is None else values[place[0]][place[1]]


def _slow(readings: dict[DriveObject, Reading], item: DriveObject | None, now_s: float) -> tuple[float, float]:
    """Value and age of what is polled; NaN and 0 where it is not measured."""
    if item is None:
        return nan, 0.0
    reading = readings.get(item)
    if reading is None:  # it was there when the drive was asked, and has not been told since
        return nan, 0.0
    return reading.value * item.scale, now_s - reading.time_s


def _polled(item: DriveObject | None, found: Capabilities) -> DriveObject | None:
    return item if item in found.present else None
