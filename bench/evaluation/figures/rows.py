"""Each figure asked for, as a number from the trials of one rig. Loads in grams at 90 degrees."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import nan, pi
from typing import Any

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import load_current_a
from bench.evaluation.figures.bounds import rest_bound_g, stroke_bound_g
from bench.evaluation.figures.coverage import Share, held
from bench.evaluation.figures.trials import SeedResults

STRAIGHT_DOWN_RAD = 0.1
Numbers = list[float]
Measure = Callable[[SeedResults, BenchConfiguration], Numbers]


@dataclass(frozen=True)
class Asked:
    """One figure.

    Attributes:
        name, unit: of the quantity.
        low, high: what it may be.
        paper: what the paper gives, in words.
        numbers: one for each seed of a rig.
        whole: of those numbers, which counts.
        note: how it is taken.
        drawn_high: what it may be at most on a drawn rig, where that is another.
        share: the trials behind it, where it is a share of trials.
    """

    name: str
    unit: str
    low: float
    high: float
    paper: str
    numbers: Measure
    whole: Callable[[Sequence[float]], float]
    note: str = ""
    drawn_high: float | None = None
    share: Callable[[SeedResults, BenchConfiguration], Share] | None = None


def _rows(seed: SeedResults, name: str) -> list[dict[str, Any]]:
    return list(seed.results.get(name, {}).get("rows", []))


def summary(name: str, key: str, scale: float = 1.0) -> Measure:
    """One number of the summary of an experiment; none where it is not there."""

    def numbers(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
        value = seed.results.get(name, {}).get(key)
        return [] if value is None else [scale * value]

    return numbers


def _errors_g(seed: SeedResults, name: str) -> Numbers:
    rows = [row for row in _rows(seed, name) if row.get("reflected_load_kg") is not None]
    return [1e3 * (row["reflected_load_kg"] - row["load_kg"]) for row in rows]


def _whole(errors_g: Callable[[SeedResults], Numbers], of: Callable[[Numbers], Any]) -> Measure:
    """One number of the errors of a seed; none where it has none."""

    def numbers(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
        found_g = errors_g(seed)
        return [float(of(found_g))] if found_g else []

    return numbers


_mean_absolute_g = _whole(lambda seed: _errors_g(seed, "loads"), lambda errors_g: np.mean(np.abs(errors_g)))
_greatest_g = _whole(lambda seed: _errors_g(seed, "loads"), lambda errors_g: np.max(np.abs(errors_g)))


def _hanging_g(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    """The largest load reflected where none has a lever."""
    hanging = [row for row in _rows(seed, "loads") if abs(row["angle_rad"]) < STRAIGHT_DOWN_RAD]
    per_g = 1e-3 * load_current_a(1.0, pi / 2, configuration.rig)
    found = [abs(row["load_current_a"]) / per_g for row in hanging if row.get("load_current_a") is not None]
    return [max(found)] if found else []


def _spread_ratio(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    steps = seed.results.get("steps", {})
    if "spread_ratio" not in steps:
        return []
    return [1.0 / steps["spread_ratio"]]


def _stroke_errors_g(seed: SeedResults) -> list[float]:
    names = ("forward_mean_error_kg", "backward_mean_error_kg")
    return [1e3 * abs(row[name]) for row in _rows(seed, "speeds") for name in names]


def _column_g(name: str) -> Callable[[SeedResults], Numbers]:
    return lambda seed: [1e3 * abs(row[name]) for row in _rows(seed, "speeds")]


_speeds_g = _whole(_column_g("mean_error_kg"), np.mean)
_strokes_g = _whole(_stroke_errors_g, np.mean)
_largest_stroke_g = _whole(_stroke_errors_g, max)
_cycles_g = _whole(_column_g("mean_absolute_error_kg"), np.mean)


def _rest_bound(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    raised = [row for row in _rows(seed, "loads") if abs(row["angle_rad"]) > STRAIGHT_DOWN_RAD]
    bound_g = rest_bound_g(raised, configuration)
    return [] if bound_g is None else [bound_g]


def _stroke_bound(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    bound_g = stroke_bound_g(configuration) if _rows(seed, "speeds") else None
    return [] if bound_g is None else [bound_g]


def _drawn(seed: SeedResults, configuration: BenchConfiguration) -> Share:
    return held(_rows(seed, "drawn"), configuration.rig)


def _swept(seed: SeedResults, configuration: BenchConfiguration) -> Share:
    """Of the load sweep, those in which the teeth carry the load."""
    raised = [row for row in _rows(seed, "loads") if abs(row["angle_rad"]) > STRAIGHT_DOWN_RAD and row["load_kg"] > 0.0]
    return held(raised, configuration.rig)


def _per_cent(share: Callable[[SeedResults, BenchConfiguration], Share]) -> Measure:
    def numbers(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
        found = share(seed, configuration)
        return [100.0 * found.held / found.trials] if found.trials else []

    return numbers


def _time(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    ours_s, theirs_s = ([row["search_s"] for row in _rows(seed, name) if row["search_s"]] for name in METHODS)
    return [float(np.mean(ours_s) / np.mean(theirs_s))] if ours_s and theirs_s else []


def _error_ratio(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    ours, theirs = (np.square(_errors_g(seed, name)) for name in METHODS)
    return [float(np.sqrt(np.mean(ours) / np.mean(theirs)))] if len(ours) and len(theirs) else []


def _time_at_accuracy(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    times, errors = _time(seed, configuration), _error_ratio(seed, configuration)
    return [time * error**2 for time, error in zip(times, errors, strict=False)]


def mean(numbers: Sequence[float]) -> float:
    """Of all; NaN of none."""
    return float(np.mean(numbers)) if len(numbers) else nan


def median(numbers: Sequence[float]) -> float:
    """Of all; NaN of none."""
    return float(np.median(numbers)) if len(numbers) else nan


def most(numbers: Sequence[float]) -> float:
    """The largest; NaN of none."""
    return float(np.max(numbers)) if len(numbers) else nan


METHODS = ("quick", "paper")
ASKED = (
    Asked("Table 1, 90 degrees: mean absolute error", "g", 0.0, 0.4, "1.11", _mean_absolute_g, mean),
    Asked("Table 1, 90 degrees: largest error", "g", 0.0, 1.0, "2.73", _greatest_g, most, "of all loads and seeds"),
    Asked(
        "25 steps at 100 g: spread compensated / uncompensated", "", 0.0, 1.0 / 40.0, "-", _spread_ratio, mean
    ),
    Asked(
        "angle 0, all loads: largest reflected load", "g", 0.0, 1.0, "'zero'", _hanging_g, most,
        "of all loads and seeds",
    ),
    Asked(
        "steady speeds 100..1200 rpm, one estimate each: mean absolute error", "g", 0.0, 0.8, "plotted", _speeds_g,
        mean,
        "Fig. 11: the estimate of a speed is the mean over its steady part, there and back; its distance from the load "
        "that hangs there, mean over the speeds",
    ),
    Asked(
        "steady speeds, each stroke by itself: mean absolute error", "g", 0.0, 0.5, "-", _strokes_g, mean,
        "the way there and the way back as two estimates: an error that is odd in direction shows here, and not in "
        "their mean; what free play alone would leave is below",
        drawn_high=1.2,
    ),
    Asked(
        "steady speeds, every control cycle by itself: mean absolute error", "g", 0.0, 1.5, "-", _cycles_g, mean,
        "what a master arm is given at any moment; it lags by half a window",
    ),
    Asked(
        "sinusoid, 50 g: error rms compensated / not", "", 0.0, 1.0 / 8.0, "future work",
        summary("sinusoid", "rms_ratio"), mean,
    ),
    Asked(
        "95 % interval of I_load holds the truth", "%", 92.0, 98.0, "-", _per_cent(_drawn), mean,
        "of trials under loads and at angles drawn at random, each rig calibrated several times; hanging straight down "
        "is left out: there the truth, 0, is the middle of what the arm's own friction may hide, and always held",
        share=_drawn,
    ),
    Asked(
        "time of a search / flow chart's, no less accurate", "", 0.0, 0.5, "1", _time, mean,
        "two breakaways each way against one; the next row gives the errors",
    ),
)  # fmt: skip
BESIDE = (
    Asked(
        "that interval, in the sweep of Table 1",
        "%",
        92.0,
        98.0,
        "-",
        _per_cent(_swept),
        mean,
        "at 90 degrees under a load, one calibration for each rig: its error is that of all its trials",
        share=_swept,
    ),
    Asked("steady speeds: largest error of one stroke", "g", 0.0, nan, "-", _largest_stroke_g, most),
    Asked("error rms of that search / flow chart's", "", 0.0, 1.0, "1", _error_ratio, mean),
    Asked(
        "that time at the same accuracy: time x error^2, ours / flow chart's",
        "",
        0.0,
        0.5,
        "1",
        _time_at_accuracy,
        mean,
        "the mean of n searches takes n times as long for an error smaller by the root of n; where its error "
        "stays, such as with asymmetric friction, no n would do",
    ),
    Asked(
        "bound of Table 1's mean error, by friction's scatter",
        "g",
        0.0,
        nan,
        "-",
        _rest_bound,
        mean,
        "what the scatter of breakaway from stop to stop leaves of so many breakaways",
    ),
    Asked(
        "a stroke's mean error, where nobody knows on which flank the arm lies",
        "g",
        0.0,
        nan,
        "-",
        _stroke_bound,
        mean,
        "what free play and count hide of the arm's acceleration, taken for load; its weight tells the flank, and "
        "friction along the path is what is left",
    ),
)
"""Shown beside, for what bounds the others."""
