"""The drive's protection of motor and stage: peak limit and I2t."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity


@dataclass(frozen=True, kw_only=True)
class Overload(Component):
    """Current mode demands no more than the peak; more than the continuous current only for a while.

        dx/dt = i^2 - ic^2, x >= 0;    fault at x = (ip^2 - ic^2) t

    The peak current is allowed for the time t after a rest, a smaller overload for longer. Needs a current sensor.
    """

    present: bool = False
    continuous_a: float = quantity("A", above=0, default=1.0)
    peak_a: float = quantity("A", above=0, default=3.0)
    peak_time_s: float = quantity("s", above=0, default=1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.peak_a <= self.continuous_a:
            self.refuse("peak_a", f"must be more than the continuous current, {self.continuous_a:g} A")

    def limited(self, demand_a: float) -> float:
        """Return the current that the drive demands of its loop [A]."""
        return min(max(demand_a, -self.peak_a), self.peak_a) if self.present else demand_a


class OverloadMeter:
    """The drive's I2t register."""

    def __init__(self, overload: Overload) -> None:
        self._overload = overload
        self._filled_a2_s = 0.0

    def overloads(self, current_a: float, period_s: float) -> bool:
        """Count a period at a current; tell whether that was too much."""
        overload = self._overload
        if not overload.present:
            return False
        continuous_a2 = overload.continuous_a**2
        self._filled_a2_s = max(self._filled_a2_s + (current_a**2 - continuous_a2) * period_s, 0.0)
        return self._filled_a2_s >= (overload.peak_a**2 - continuous_a2) * overload.peak_time_s
