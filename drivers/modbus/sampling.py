"""From register values to a sample."""

import time
from math import nan

from drivers.contract import Ages, Sample, Status
from drivers.joint import JointScale
from drivers.modbus.power_stage import Values
from drivers.modbus.register_map import RegisterMap
from drivers.wraps import DriveClock

_SAMPLE_NAMES = {
    "time_s": "time_s",
    "position_counts": "position_rad",
    "velocity_counts_s": "velocity_rad_s",
    "duty": "duty",
    "current_a": "current_a",
    "supply_v": "supply_v",
    "temperature_c": "temperature_c",
}
_IN_COUNTS = frozenset({"position_counts", "velocity_counts_s"})


class Sampling:
    """Puts samples together, of what was read in this cycle and what was kept from a slower request."""

    def __init__(self, register_map: RegisterMap, joint: JointScale) -> None:
        self._names = {part: register.name for part, register in register_map.measured.items()}
        self._steps = {part: abs(register.scale) for part, register in register_map.measured.items()}
        self._joint = joint
        clock = register_map.measured.get("time_s")
        self._clock = None if clock is None else DriveClock(clock.scale, clock.number.words * 16)
        self._kept: Values = {}
        self._kept_at_s = 0.0

    @property
    def measured(self) -> frozenset[str]:
        """Names of the `Sample` fields that are measured."""
        return frozenset({"time_s", *(_SAMPLE_NAMES[part] for part in self._names)})

    @property
    def resolution(self) -> dict[str, float]:
        """Smallest step of each quantity, in its unit."""
        count_rad = self._joint.count_rad
        return {
            _SAMPLE_NAMES[part]: step * (count_rad if part in _IN_COUNTS else 1.0) for part, step in self._steps.items()
        }

    def keep(self, values: Values) -> None:
        """Keep what is read only now and then."""
        self._kept |= values
        self._kept_at_s = time.perf_counter()

    def sample(self, values: Values, state: Status, at_s: float) -> Sample:
        """The sample of values that were asked for at a time [s]."""
        now_s = time.perf_counter()
        age_s = now_s - at_s
        slow_age_s = now_s - self._kept_at_s if self._kept else age_s
        joint, sign = self._joint, self._joint.motor_sign
        if self._clock is not None:
            at_s = self._clock.follow(values[self._names["time_s"]])
        return Sample(
            at_s, age_s,
            joint.position_rad(self._value("position_counts", values)),
            joint.velocity_rad_s(self._value("velocity_counts_s", values)),
            sign * self._value("duty", values), sign * self._value("current_a", values),
            self._value("supply_v", values), self._value("temperature_c", values),
            state, Ages(age_s, age_s, age_s, age_s, slow_age_s, slow_age_s, age_s),
        )  # fmt: skip

    def output(self, values: Values) -> tuple[float, float]:
        """Applied duty, -1 .. 1, and motor current [A]; NaN where the drive has no register for it."""
        sign = self._joint.motor_sign
        return sign * self._value("duty", values), sign * self._value("current_a", values)

    def _value(self, part: str, values: Values) -> float:
        """Of this cycle, or kept; NaN where the drive has no register for it."""
        name = self._names.get(part, "")
        return values[name] if name in values else self._kept.get(name, nan)
