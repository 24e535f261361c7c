"""From what the TPDOs and the slow poll tell to a sample, in SI, at the joint. Pure."""

from math import copysign, isnan, nan

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.objects import VELOCITY, DriveObject
from drivers.canopen.cia301.pdo import PdoLayout
from drivers.canopen.slow_poll import Reading
from drivers.contract import Ages, Sample, Status


class Measurement:
    """Turns counts into samples.

    Args:
        found: scales and objects of the drive.
        state, motion: layouts of the two TPDOs: statusword first, position first.
    """

    def __init__(self, found: Capabilities, state: PdoLayout, motion: PdoLayout) -> None:
        scale, profile = found.scale, found.profile
        self._joint = scale.joint
        self._velocity_rad_s = scale.velocity_rad_s if VELOCITY in motion.entries else nan
        self._current_place = _place(state, found.current)
        self._current_a = nan if found.current is None else scale.joint.motor_sign * scale.current_a(found.current)
        self._duty_place = _place(state, profile.duty)
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
            "current_a": self._current_place > 0,
            "duty": self._duty_place > 0,
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
        self, state: tuple[int, ...], motion: tuple[int, ...], slow: dict[DriveObject, Reading], status: Status,
        sync_s: float, now_s: float, number: int,
    ) -> Sample:  # fmt: skip
        """The sample of a cycle.

        Args:
            state: values of the TPDO with the statusword.
            motion: values of the TPDO with the position.
            slow: what the poll has.
            status: state of the power stage.
            sync_s: when the SYNC was sent at which the drive measured [s].
            now_s: the time now [s].
            number: of the SYNC.
        """
        current_a = state[self._current_place] * self._current_a if self._current_place else nan
        # the magnitude is all that the drive tells
        duty = copysign(state[self._duty_place] * self._duty_scale, current_a) if self._duty_place else nan
        supply_v, supply_age_s = _slow(slow, self._supply, now_s)
        temperature_c, temperature_age_s = _slow(slow, self._temperature, now_s)
        age_s = now_s - sync_s
        return Sample(
            sync_s,
            age_s,
            self._joint.position_rad(motion[0]),
            motion[1] * self._velocity_rad_s if len(motion) > 1 else nan,
            duty,
            current_a,
            supply_v,
            temperature_c,
            status,
            Ages(age_s, age_s, age_s, age_s, supply_age_s, temperature_age_s, age_s),
            number,
        )


def _slow(readings: dict[DriveObject, Reading], item: DriveObject | None, now_s: float) -> tuple[float, float]:
    """Value and age of what is polled; NaN and 0 where it is not measured."""
    if item is None:
        return nan, 0.0
    value, time_s = readings[item]  # each was read when the drive was opened
    return value * item.scale, now_s - time_s


def _place(layout: PdoLayout, item: DriveObject | None) -> int:
    """Where an object is in a TPDO; 0 where it is not (the first place is taken)."""
    return layout.entries.index(item) if item in layout.entries and item is not None else 0


def _polled(item: DriveObject | None, found: Capabilities) -> DriveObject | None:
    return item if item in found.present else None
