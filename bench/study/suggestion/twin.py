"""The joint of a fitted model behind the drive contract: experiments run on it as they would on the bench.

So a trial's rows are predicted by its own procedure, whatever kind it is, and one that would stall, trip or never
settle is seen before anybody waits for it.
"""

from math import isnan, nan, pi

from bench.config.rig import Rig
from bench.study.suggestion.dynamics import Dynamics
from drivers.contract import Command, Description, Inspection, Mode, Sample, Status

STEPS = 2  # of the equation of motion per control cycle
WATCHDOG_S = 1.0


class Twin:
    """A drive in virtual time, and who hangs its loads.

    Args:
        dynamics: of the joint.
        rig: its encoder, motor and supply.
        temperature_c: that is reported all along; NaN for none.
    """

    def __init__(self, dynamics: Dynamics, rig: Rig, temperature_c: float) -> None:
        self._dynamics, self._temperature_c = dynamics, temperature_c
        self._count_rad = 2.0 * pi / ((rig.sensor.counts_per_turn or 4096.0) * (rig.gear.ratio or 1.0))
        self._resistance_ohm = rig.motor.resistance_ohm
        self._back_emf_v_s_rad = (rig.motor.back_emf_v_s_rad or nan) * (rig.gear.ratio or nan)
        self._supply_v = rig.supply.voltage_v or nan
        self._period_s = nan
        self._time_s = 0.0
        self._position_rad = self._velocity_rad_s = 0.0
        self._load_kg = self._moment_kg = 0.0
        self._status = Status.DISABLED

    def hang_load(self, load_kg: float, balanced: bool) -> None:
        """Hang a load at once, and let the arm hang down again: each trial begins afresh."""
        self._load_kg, self._moment_kg = load_kg, 0.0 if balanced else load_kg
        self._position_rad = self._velocity_rad_s = 0.0

    def describe(self) -> Description:
        """Identity and capabilities."""
        return Description(
            device="fitted model", vendor="", product="", firmware="", serial="", simulated=True,
            modes=frozenset({Mode.CURRENT, Mode.DUTY}), measured=frozenset({"position_rad", "current_a"}),
            resolution={}, max_rate_hz=1.0e4, watchdog_s=WATCHDOG_S,
        )  # fmt: skip

    def open(self, period_s: float) -> None:
        """Set the control period [s]."""
        self._period_s = period_s

    def close(self) -> None:
        """Power off."""
        self._status = Status.DISABLED

    def enable(self, mode: Mode) -> None:  # noqa: ARG002
        """Power the stage."""
        self._status = Status.ENABLED

    def disable(self) -> None:
        """Power off."""
        self._status = Status.DISABLED

    def quick_stop(self) -> None:
        """Power off: friction brakes a model."""
        self._status = Status.DISABLED

    def inspect(self) -> Inspection:
        """The state; it has no fault, and tells no output."""
        return Inspection(self._status)

    def clear_fault(self) -> None:
        """There is none."""

    def exchange(self, command: Command) -> Sample:
        """Advance by one period under a command, and measure."""
        current_a = self._current_a(command)
        position, velocity = self._position_rad, self._velocity_rad_s
        step_s = self._period_s / STEPS
        for _ in range(STEPS):
            position, velocity = self._dynamics.step(
                position, velocity, current_a, self._load_kg, self._moment_kg, step_s
            )
        self._position_rad, self._velocity_rad_s = position, velocity
        self._time_s += self._period_s
        return Sample(
            time_s=self._time_s,
            age_s=0.0,
            position_rad=self._count_rad * round(position / self._count_rad),
            velocity_rad_s=nan,
            duty=self._duty(current_a),
            current_a=current_a,
            supply_v=self._supply_v,
            temperature_c=self._temperature_c,
            status=self._status,
        )

    def _current_a(self, command: Command) -> float:
        if self._status is not Status.ENABLED or command.mode is Mode.OFF:
            return 0.0
        if command.mode is Mode.CURRENT:
            return self._within_supply(command.value)
        if self._resistance_ohm is None:
            return 0.0
        return (command.value * self._supply_v - self._back_emf_v_s_rad * self._velocity_rad_s) / self._resistance_ohm

    def _within_supply(self, current_a: float) -> float:
        """The current, or as much of it as the supply can drive at this speed."""
        if self._resistance_ohm is None or isnan(self._supply_v) or isnan(self._back_emf_v_s_rad):
            return current_a
        back_v = self._back_emf_v_s_rad * self._velocity_rad_s
        low_a, high_a = ((sign * self._supply_v - back_v) / self._resistance_ohm for sign in (-1.0, 1.0))
        return min(max(current_a, low_a), high_a)

    def _duty(self, current_a: float) -> float:
        if self._resistance_ohm is None:
            return nan
        return (self._resistance_ohm * current_a + self._back_emf_v_s_rad * self._velocity_rad_s) / self._supply_v
