"""A recorded trial, replayed to a rival: the same samples for all of them."""

from dataclasses import dataclass, replace
from math import nan

import numpy as np

from bench.config.reflected_load import load_current_a
from bench.config.rig import Rig
from bench.evaluation.rivals.record import Recorded
from compensator.motion.kinetic_friction import FloatArray
from compensator.motion.load_estimate import Observation, RestResult
from compensator.rivals.rival import Knowledge, Rival, smoothed


@dataclass(frozen=True)
class Span:
    """Rows of a trial, from the first to before the last."""

    first: int
    last: int


def current_of(trial: Recorded) -> FloatArray:
    """Motor current [A]: measured, else by eq. (3)."""
    measured = trial.channels["current_a"]
    return np.where(np.isfinite(measured), measured, trial.channels["current_estimate_a"])


def search_of(trial: Recorded) -> Span | None:
    """The rows in which zero-speed searches had the joint; None where there was none."""
    times_s = [event.time_s for event in trial.events if event.name == "search"]
    if not times_s:
        return None
    first, last = np.searchsorted(trial.channels["time_s"], [times_s[0], times_s[-1]])
    return Span(int(first), int(last))


def motion_of(trial: Recorded) -> Span:
    """The rows in which the set point moves away from angle 0 and back again."""
    away = np.flatnonzero(np.abs(trial.channels["target_rad"]) > 0.0)
    return Span(int(away[0]), int(away[-1]) + 1)


def replay(rival: Rival, knowledge: Knowledge, trial: Recorded, rest: RestResult | None, rest_row: int) -> FloatArray:
    """The load current [A] that a rival gives for every row, shape (rows,).

    Args:
        rival: it begins anew.
        knowledge: of the joint.
        trial: as recorded.
        rest: what zero-speed searches found, for those who use them.
        rest_row: the row in which it is known. While the trial's own searches have the joint, the rival is told so.
    """
    search, channels = search_of(trial), trial.channels
    state, given = rival.begin(knowledge), np.full(len(channels["time_s"]), nan)
    current_a = current_of(trial)
    for row, (position_rad, target_rad) in enumerate(
        zip(channels["position_rad"].tolist(), channels["target_rad"].tolist(), strict=True)
    ):
        searching = search is not None and search.first <= row < search.last
        told = rest if row == rest_row and rival.searches else None
        seen = Observation(position_rad, float(current_a[row]), target_rad, searching, told)
        state, estimate = rival.advance(knowledge, state, seen)
        given[row] = estimate.load_current_a
    return given if rival.filters else smoothed(given, knowledge.settings.period_s)


def standing_on(trial: Recorded, row: int, cycles: int) -> Recorded:
    """The trial up to a row, and the joint goes on standing there for so many cycles."""
    channels = {
        name: np.concatenate([values[: row + 1], np.repeat(values[row], cycles)])
        for name, values in trial.channels.items()
    }
    return replace(trial, channels=channels)


def truth_of(trial: Recorded, rig: Rig) -> FloatArray:
    """The current [A] of what is truly on the arm: the load's gravity and a wall; shape (rows,)."""
    load_kg = float(trial.conditions["load_kg"])
    one_a = load_current_a(load_kg, np.pi / 2, rig)
    torque_n_m_a = (rig.motor.torque_constant_n_m_a or nan) * (rig.gear.ratio or nan)
    wall_a = np.where(np.isnan(trial.channels["wall_n_m"]), 0.0, trial.channels["wall_n_m"]) / torque_n_m_a
    return np.asarray(one_a * np.sin(trial.channels["position_rad"]) - wall_a)
