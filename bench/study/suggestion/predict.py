"""What each possible trial would show, by the model fitted so far: every one is run on the model's own joint.

The model stands behind the drive contract, so a trial's rows are predicted by its own procedure, whatever kind it is,
and one that would stall, trip or never settle is seen before anybody waits for it.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import isnan, nan, pi

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.rig import Rig
from bench.control.drive_factory import Equipment, is_simulated
from bench.errors import BenchError
from bench.runs.in_memory import InMemoryBench
from bench.study.models.stages import CHOOSING, SIMULATING
from bench.study.suggestion.dynamics import Dynamics, dynamics_of
from bench.study.suggestion.options import Choice
from compensator.lab import progress
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.model.fitted import Fit
from compensator.lab.next_trial.suggest import suggest
from compensator.lab.next_trial.suggestion import Option, Suggestion
from compensator.lab.recordings.recording import SESSION_START, Condition, Recording
from compensator.lab.rows.dataset import Dataset
from drivers.contract import Command, Description, Inspection, Mode, Sample, Status
from drivers.errors import DriveError

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


def predicted(fit: Fit, configuration: BenchConfiguration, found: Sequence[Choice], once: bool = False) -> list[Option]:
    """The options whose trials the model's joint completes; `once` says that each tells nothing more the second time.

    Raises:
        StudyError: the model or the rig does not say how the joint moves.
    """
    progress.enter(SIMULATING)
    dynamics = dynamics_of(fit, configuration.rig)
    cold = is_simulated(configuration)  # a simulated joint is made anew for each experiment
    twin = Twin(dynamics, configuration.rig, _temperature_c(fit.dataset, cold))
    options = []
    with InMemoryBench(configuration, Equipment(twin, twin)) as bench:
        for choice in progress.each(found):
            try:
                recordings = [bench.record(plan, choice.kind) for plan in choice.plans]
            except (BenchError, DriveError):
                continue  # it stalls, trips or does not settle
            whole = tuple(_as_measured(one, fit.dataset, cold) for one in recordings)
            options.append(Option(choice.name, choice.duration_s / 60.0, whole, once))
    return options


def choose(
    fit: Fit,
    diagnosis: Diagnosis,
    configuration: BenchConfiguration,
    found: Sequence[Choice],
    most: int,
    once: bool = False,
) -> tuple[Suggestion, list[Choice]]:
    """What separates the rivals of a diagnosis most, and the experiments to start for it, in the same order.

    Args:
        fit: the diagnosed model.
        diagnosis: of it.
        configuration: of the bench.
        found: experiments that it could run.
        most: how many are chosen at most.
        once: each tells nothing more the second time: the bench repeats its very samples.

    Raises:
        StudyError, LabError: as `predicted` and `suggest`.
    """
    options = predicted(fit, configuration, found, once)
    progress.enter(CHOOSING)
    suggestion = suggest(fit, diagnosis, options, most)
    by_name = {choice.name: choice for choice in found}
    return suggestion, [by_name[pick.name] for pick in suggestion.picks]


def _as_measured(recording: Recording, dataset: Dataset, cold: bool) -> Recording:
    """The recording with the channels that the study's trials have, and as late in the session as it would be."""
    ones = np.ones(len(recording))
    filled = {name: ones for name in dataset.effort_definition.channels if name not in recording.channels}
    conditions: dict[str, Condition] = dict(recording.conditions)
    started = [trial.motion.conditions.get(SESSION_START) for trial in dataset.trials]
    if all(isinstance(one, int | float) for one in started):
        conditions[SESSION_START] = 0.0 if cold else max(float(t.motion.session_s[-1]) for t in dataset.trials)
    return replace(recording, channels={**recording.channels, **filled}, conditions=conditions)


def _temperature_c(dataset: Dataset, cold: bool) -> float:
    """At the start of the first trial, or at the end of the last one; NaN where it is not measured."""
    temperatures = [trial.motion.temperature_c for trial in dataset.trials]
    if not all(np.isfinite(one).all() for one in temperatures):
        return nan
    return float(temperatures[0][0] if cold else temperatures[-1][-1])
