"""Each figure asked for, as a number from the trials of one rig. Loads in grams at 90 degrees."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import nan, pi
from typing import Any

import numpy as np

from bench.configuration import BenchConfiguration
from bench.figures.bounds import rest_bound_g, stroke_bound_g
from bench.figures.trials import SeedResults
from bench.reflected_load import load_current_a

STRAIGHT_DOWN_RAD = 0.1
Numbers = list[float]


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
    """

    name: str
    unit: str
    low: float
    high: float
    paper: str
    numbers: Callable[[SeedResults, BenchConfiguration], Numbers]
    whole: Callable[[Sequence[float]], float]
    note: str = ""


def _rows(seed: SeedResults, name: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = seed.results.get(name, {}).get("rows", [])
    return rows


def _summary(seed: SeedResults, name: str, key: str, scale: float = 1.0) -> Numbers:
    value = seed.results.get(name, {}).get(key)
    return [] if value is None else [scale * value]


def _errors_g(seed: SeedResults, name: str) -> Numbers:
    rows = [row for row in _rows(seed, name) if row.get("reflected_load_kg") is not None]
    return [1e3 * (row["reflected_load_kg"] - row["load_kg"]) for row in rows]


def _mean_absolute_g(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    errors_g = _errors_g(seed, "loads")
    return [float(np.mean(np.abs(errors_g)))] if errors_g else []


def _greatest_g(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    errors_g = _errors_g(seed, "loads")
    return [float(np.max(np.abs(errors_g)))] if errors_g else []


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


def _speeds_g(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    errors_g = [1e3 * abs(row["mean_error_kg"]) for row in _rows(seed, "speeds")]
    return [float(np.mean(errors_g))] if errors_g else []


def _strokes_g(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    names = ("forward_mean_error_kg", "backward_mean_error_kg")
    errors_g = [1e3 * abs(row[name]) for row in _rows(seed, "speeds") for name in names]
    return [float(np.mean(errors_g))] if errors_g else []


def _rest_bound(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    raised = [row for row in _rows(seed, "loads") if abs(row["angle_rad"]) > STRAIGHT_DOWN_RAD]
    bound_g = rest_bound_g(raised, configuration)
    return [] if bound_g is None else [bound_g]


def _stroke_bound(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    bound_g = stroke_bound_g(configuration) if _rows(seed, "speeds") else None
    return [] if bound_g is None else [bound_g]


def _sinusoid(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    return _summary(seed, "sinusoid", "rms_ratio")


def _held(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    """Per cent of the trials whose interval holds the truth."""
    return _held_in(_rows(seed, "loads"), configuration)


def _held_raised(seed: SeedResults, configuration: BenchConfiguration) -> Numbers:
    """The same, of those in which the teeth carry the load."""
    return _held_in([row for row in _rows(seed, "loads") if abs(row["angle_rad"]) > STRAIGHT_DOWN_RAD], configuration)


def _held_in(rows: list[dict[str, Any]], configuration: BenchConfiguration) -> Numbers:
    held = []
    for row in rows:
        if row.get("load_interval_a") is not None:
            low_a, high_a = row["load_interval_a"]
            held.append(low_a <= load_current_a(row["load_kg"], row["angle_rad"], configuration.rig) <= high_a)
    return [100.0 * sum(held) / len(held)] if held else []


def _time(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    ours_s, theirs_s = ([row["search_s"] for row in _rows(seed, name) if row["search_s"]] for name in METHODS)
    return [float(np.mean(ours_s) / np.mean(theirs_s))] if ours_s and theirs_s else []


def _error_ratio(seed: SeedResults, _configuration: BenchConfiguration) -> Numbers:
    ours, theirs = (np.square(_errors_g(seed, name)) for name in METHODS)
    return [float(np.sqrt(np.mean(ours) / np.mean(theirs)))] if len(ours) and len(theirs) else []


def _mean(numbers: Sequence[float]) -> float:
    return float(np.mean(numbers)) if len(numbers) else nan


def _most(numbers: Sequence[float]) -> float:
    return float(np.max(numbers)) if len(numbers) else nan


METHODS = ("quick", "paper")
ASKED = (
    Asked("Table 1, 90 degrees: mean absolute error", "g", 0.0, 0.4, "1.11", _mean_absolute_g, _mean),
    Asked("Table 1, 90 degrees: largest error", "g", 0.0, 1.0, "2.73", _greatest_g, _most, "of all loads and seeds"),
    Asked(
        "25 steps at 100 g: spread compensated / uncompensated", "", 0.0, 1.0 / 40.0, "-", _spread_ratio, _mean
    ),
    Asked(
        "angle 0, all loads: largest reflected load", "g", 0.0, 1.0, "'zero'", _hanging_g, _most,
        "of all loads and seeds",
    ),
    Asked(
        "steady speeds 100..1200 rpm: mean absolute error", "g", 0.0, 0.8, "plotted", _speeds_g, _mean,
        "there and back at each speed",
    ),
    Asked(
        "steady speeds: mean absolute error of each stroke", "g", 0.0, 0.8, "plotted", _strokes_g, _mean,
        "each way at each speed by itself, as a single reading of the paper's Fig. 11",
    ),
    Asked("sinusoid, 50 g: error rms compensated / not", "", 0.0, 1.0 / 8.0, "future work", _sinusoid, _mean),
    Asked("95 % interval of I_load holds the truth", "%", 92.0, 98.0, "-", _held, _mean, "of the load sweep's trials"),
    Asked(
        "time of a search / flow chart's, no less accurate", "", 0.0, 0.5, "1", _time, _mean,
        "two breakaways each way against one; the next row gives the errors",
    ),
)  # fmt: skip
BESIDE = (
    Asked(
        "that interval, 90 degrees alone",
        "%",
        92.0,
        98.0,
        "-",
        _held_raised,
        _mean,
        "hanging straight down the truth, 0, is the middle of what the arm's own friction may hide: always held",
    ),
    Asked("error rms of that search / flow chart's", "", 0.0, 1.0, "1", _error_ratio, _mean),
    Asked(
        "bound of Table 1's mean error, by friction's scatter",
        "g",
        0.0,
        nan,
        "-",
        _rest_bound,
        _mean,
        "what the scatter of breakaway from stop to stop leaves of so many breakaways",
    ),
    Asked(
        "bound of a stroke's mean error, by free play and count",
        "g",
        0.0,
        nan,
        "-",
        _stroke_bound,
        _mean,
        "what the motor's encoder does not know of the arm's acceleration, taken for load",
    ),
)
"""Shown beside, for what bounds the others."""
