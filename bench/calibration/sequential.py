"""A friction calibration that measures where it knows least, and stops when it knows enough or its time is up.

At first some speeds over the whole range under a load; from then on, in small batches, the speeds at which the fitted
curve is known least (the variance of a prediction as the criterion of the next experiment: Fedorov, "Theory of Optimal
Experiments", 1972, chapter 2.5). Every batch is an experiment of its own: whoever stops between two goes on later with
the same records.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from bench.calibration.calibrate import f_loads
from bench.calibration.curves import friction_fits
from bench.calibration.points import FrictionPoint, Row, friction_points
from bench.config.configuration import BenchConfiguration
from bench.experiments.kinds.speed_sweep import SpeedSweepParameters, stroke_settings
from bench.experiments.parts.stroke import OVERSPEED
from bench.json_types import Values
from bench.store import Trial
from compensator.errors import CalibrationError

SLOWEST_RAD_S = 0.03
FIRST, BATCH = 10, 3  # speeds, each in both directions
CANDIDATES = 40
FASTEST_SHARE = 0.85  # of what the travel lets one measure
STROKE_S = 4.5  # at one speed one way, the way back included: what a bench takes on average
STRAIGHT_SHARE = 0.1  # of friction at the middle load, that it may be off the line through both ends
APART = 1.25  # speeds of a batch differ by that factor at least


@dataclass(frozen=True, slots=True)
class Batch:
    """What to measure next.

    Attributes:
        load_kg: balanced on the arm.
        half_width_a: half of the 95 % interval of the load's curve where it is known least; inf before the first fit.
        duration_s: that it takes, roughly.
    """

    load_kg: float
    parameters: Values
    half_width_a: float
    duration_s: float


@dataclass(frozen=True, slots=True)
class SequentialDesign:
    """What a calibration is to reach, and in which time.

    Attributes:
        loads_kg: under which a curve is measured, in the order they are hung.
        accuracy_a: half of the 95 % interval of each curve at its worst speed, at which it is known well enough.
        budget_s: time of the joint, shared out among the loads.
        duties: constant duties under the first load, in both directions, which tell the motor's constants.
    """

    configuration: BenchConfiguration
    loads_kg: tuple[float, ...]
    accuracy_a: float
    budget_s: float
    duties: tuple[float, ...] = ()

    @property
    def longest_s(self) -> float:
        """Time that it takes at most [s]: at least the first speeds of each load are measured."""
        first_s = len(self.loads_kg) * FIRST * 2 * STROKE_S
        return max(self.budget_s, first_s) + len(self.duties) * 2 * STROKE_S * 3

    def next(self, points: Mapping[float, Sequence[FrictionPoint]], spent_s: Mapping[float, float]) -> Batch | None:
        """What to measure next; None where every curve is known well enough, or its time is up.

        Args:
            points: of each load so far.
            spent_s: time of the joint under each load so far [s].
        """
        for number, load_kg in enumerate(self.loads_kg):
            known = points.get(load_kg, ())
            if not known:
                return self._batch(load_kg, self._speeds(FIRST), float("inf"), self.duties if number == 0 else ())
            speeds, half_width_a = self._least_known(load_kg, known)
            # what the loads before have left over is for those that follow
            before_s = sum(spent_s.get(one, 0.0) for one in self.loads_kg[:number])
            share_s = (self.budget_s - before_s) / (len(self.loads_kg) - number)
            left_s = share_s - spent_s.get(load_kg, 0.0)
            if half_width_a > self.accuracy_a and left_s >= BATCH * 2 * STROKE_S:
                return self._batch(load_kg, speeds, half_width_a, ())
        return None

    def _batch(
        self, load_kg: float, speeds_rad_s: Sequence[float], half_width_a: float, duties: Sequence[float]
    ) -> Batch:
        parameters: Values = {
            "loads_kg": [load_kg],
            "currents_a": [],
            "duties": list(duties),
            "speeds_rad_s": list(speeds_rad_s),
            "top_speed_rad_s": max(self._fastest_rad_s(), *speeds_rad_s),
            "strokes": 4,
        }
        strokes = len(speeds_rad_s) + 3 * len(duties)
        return Batch(load_kg, parameters, half_width_a, 2 * STROKE_S * strokes)

    def _least_known(self, load_kg: float, points: Sequence[FrictionPoint]) -> tuple[list[float], float]:
        """The speeds at which a curve is known least, and half of its interval at the worst of them."""
        speeds, ratio = np.array(self._speeds(CANDIDATES)), self.configuration.rig.gear.ratio or 1.0
        try:
            found = friction_fits({load_kg: points})[load_kg].half_width_a(speeds * ratio)
        except CalibrationError:  # too few yet
            return self._speeds(BATCH), float("inf")
        chosen: list[float] = []
        for place in np.argsort(-found):
            speed = float(speeds[place])
            if all(max(speed / other, other / speed) >= APART for other in chosen):
                chosen.append(speed)
            if len(chosen) == BATCH:
                break
        return sorted(chosen), float(np.max(found))

    def _speeds(self, count: int) -> list[float]:
        fastest = self._fastest_rad_s()
        return [float(f"{one:.3g}") for one in np.geomspace(min(SLOWEST_RAD_S, fastest / 10.0), fastest, count)]

    def _fastest_rad_s(self) -> float:
        """The fastest that limits and travel let one measure."""
        defaults = SpeedSweepParameters()
        travel = stroke_settings(defaults, self.configuration).greatest_speed_rad_s()
        limit = self.configuration.limits.speed_rad_s / OVERSPEED
        return float(f"{FASTEST_SHARE * min(travel, limit, defaults.top_speed_rad_s):.3g}")


def measured(trials: Sequence[Trial], period_s: float) -> tuple[dict[float, list[FrictionPoint]], dict[float, float]]:
    """Points of each load [kg], and time of the joint under each [s], of the trials of speed sweeps.

    Args:
        trials: completed; those of other kinds are left out.
        period_s: control period that they were run at.
    """
    rows: list[Row] = [
        {**trial.conditions, **trial.results} for trial in trials if "motor_speed_rad_s" in trial.results
    ]
    spent: dict[float, float] = {}
    for row in rows:
        spent[float(row["load_kg"])] = spent.get(float(row["load_kg"]), 0.0) + float(row["cycles"]) * period_s
    return (friction_points(rows) if rows else {}), spent


def loads_of(trials: Sequence[Trial], ends_kg: Sequence[float], middle_kg: float) -> tuple[float, ...]:
    """Under which loads curves are to be measured: both ends, and the middle where friction does not grow straight.

    Args:
        trials: of a load sweep over these loads at angle 0.
        ends_kg: lightest and heaviest.
        middle_kg: half way between them.
    """
    found = {load_kg: one[0] for load_kg, one in f_loads(trials).items()}
    if not {*ends_kg, middle_kg} <= found.keys():
        return (*ends_kg, middle_kg)
    straight_a = float(np.interp(middle_kg, ends_kg, [found[load_kg] for load_kg in ends_kg]))
    bends = abs(found[middle_kg] - straight_a) > STRAIGHT_SHARE * straight_a
    return (*ends_kg, middle_kg) if bends else tuple(ends_kg)
