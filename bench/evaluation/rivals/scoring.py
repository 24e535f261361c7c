"""How far a rival's estimate is from what is truly on the arm: at rest, at steady speeds, in a sinusoid, at a wall."""

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bench.config.rig import Rig
from bench.evaluation.rivals.record import Recorded
from bench.evaluation.rivals.replay import Span, current_of, motion_of, replay, search_of, standing_on, truth_of
from compensator.motion.kinetic_friction import FloatArray
from compensator.motion.load_estimate import RestResult
from compensator.rivals import Knowledge, Rival

REGIMES = ("at rest", "steady speed", "sinusoid", "reversal", "wall")
STEADY_CYCLES = 40  # that a set point has kept its speed before it counts as steady
REVERSAL_S = 0.15  # after the set point turns
WALL_CYCLES = 60  # that the joint has stood at the wall
STANDING_CYCLES = 100  # that a joint at rest goes on standing
FADE_S = 2.0  # of a motion, not scored
Mask = NDArray[np.bool_]


@dataclass
class Score:
    """What one rival got.

    Attributes:
        errors_g: regime -> errors, in grams at 90 degrees; without those of no estimate.
        missing: regime -> rows, or trials at rest, without an estimate.
        seconds, travel_rad, energy_j: of each zero-speed search that it needed.
    """

    errors_g: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    missing: dict[str, int] = field(default_factory=lambda: defaultdict(int))
    seconds: list[float] = field(default_factory=list)
    travel_rad: list[float] = field(default_factory=list)
    energy_j: list[float] = field(default_factory=list)

    def mean_g(self, regime: str) -> float | None:
        """Mean absolute error; None without an estimate."""
        errors = self.errors_g[regime]
        return float(np.mean(np.abs(errors))) if errors else None

    def max_g(self, regime: str) -> float | None:
        """Largest error; None without an estimate."""
        errors = self.errors_g[regime]
        return float(np.max(np.abs(errors))) if errors else None

    def add(self, regime: str, errors_g: FloatArray) -> None:
        """Take in the errors of some rows."""
        told = errors_g[np.isfinite(errors_g)]
        self.errors_g[regime] += told.tolist()
        self.missing[regime] += len(errors_g) - len(told)


def score_rest(score: Score, rival: Rival, knowledge: Knowledge, trial: Recorded, rig: Rig, per_kg_a: float) -> None:
    """A trial at rest, half a second on: before the search for rivals that need none, after it for the others."""
    search = search_of(trial)
    if search is None:
        return
    rest = None
    if rival.searches:
        _count(score, trial, search)
        rest = result_of(trial)
        if rest is None:
            score.missing["at rest"] += 1
            return
    last = search.last if rival.searches else max(search.first - 1, 0)
    stood = standing_on(trial, last, STANDING_CYCLES)
    given_a, truth_a = replay(rival, knowledge, stood, rest, search.last), truth_of(stood, rig)
    score.add("at rest", 1e3 * (given_a[-1:] - truth_a[-1:]) / per_kg_a)


def score_motion(
    score: Score,
    rival: Rival,
    knowledge: Knowledge,
    trial: Recorded,
    rig: Rig,
    rest: RestResult | None,
    masks: dict[str, Mask],
    per_kg_a: float,
) -> None:
    """A trial in motion: the rows of each regime. What hangs there was searched for before."""
    search = search_of(trial)
    given_a = replay(rival, knowledge, trial, rest, search.last if search is not None else 0)
    errors_g = 1e3 * (given_a - truth_of(trial, rig)) / per_kg_a
    for regime, mask in masks.items():
        score.add(regime, errors_g[mask])


def result_of(trial: Recorded) -> RestResult | None:
    """What the searches of a trial at rest found; None where they found nothing."""
    found = trial.results
    if found.get("load_current_a") is None:
        return None
    low_a, high_a = found.get("load_interval_a") or (found["load_current_a"], found["load_current_a"])
    half_a = max(high_a - found["load_current_a"], found["load_current_a"] - low_a)
    return RestResult(found["load_current_a"], half_a, found["friction_current_a"])


def steady_rows(trial: Recorded) -> Mask:
    """Where the set point has moved at one speed for a while."""
    speed = np.diff(trial.channels["target_rad"], prepend=trial.channels["target_rad"][0])
    same = (np.abs(np.diff(speed, prepend=0.0)) < 1e-9) & (np.abs(speed) > 1e-6)
    return _lasting(same, STEADY_CYCLES) & _moving(trial)


def sinusoid_rows(trial: Recorded) -> Mask:
    """The motion, less its beginning."""
    moving = _moving(trial)
    started = motion_of(trial).first
    late = trial.channels["time_s"] > trial.channels["time_s"][started] + FADE_S
    return np.asarray(moving & late)


def reversal_rows(trial: Recorded) -> Mask:
    """A while after each turn of the set point."""
    speed = np.sign(np.diff(trial.channels["target_rad"], prepend=trial.channels["target_rad"][0]))
    turned = np.flatnonzero((speed[1:] * speed[:-1]) < 0.0) + 1
    period_s = float(np.median(np.diff(trial.channels["time_s"])))
    mask = np.zeros(len(speed), dtype=bool)
    for row in turned:
        mask[row : row + round(REVERSAL_S / period_s)] = True
    return mask & sinusoid_rows(trial)


def wall_rows(trial: Recorded) -> Mask:
    """Where the arm has leant on the wall, and stood, for a while."""
    leans = np.abs(trial.channels["wall_n_m"]) > 1e-6
    stands = np.abs(np.diff(trial.channels["position_rad"], prepend=np.nan)) < 1e-3
    return _lasting(leans & stands, WALL_CYCLES)


def _count(score: Score, trial: Recorded, search: Span) -> None:
    """Time, way and electrical energy of the search."""
    rows, channels = slice(search.first, search.last + 1), trial.channels
    time_s = channels["time_s"][rows]
    power_w = channels["supply_v"][rows] * channels["duty"][rows] * current_of(trial)[rows]
    searches = max(len(trial.results.get("load_currents_a") or [None]), 1)
    score.seconds.append(float(time_s[-1] - time_s[0]) / searches)
    score.travel_rad.append(float(np.sum(np.abs(np.diff(channels["position_rad"][rows])))) / searches)
    score.energy_j.append(float(np.sum(power_w[1:] * np.diff(time_s))) / searches)


def _moving(trial: Recorded) -> Mask:
    span, rows = motion_of(trial), np.arange(len(trial.channels["time_s"]))
    return (rows >= span.first) & (rows < span.last)


def _lasting(mask: Mask, cycles: int) -> Mask:
    """Where a condition has held for that many cycles."""
    held = np.zeros(len(mask), dtype=int)
    for row in range(1, len(mask)):
        held[row] = held[row - 1] + 1 if mask[row] else 0
    return held >= cycles
