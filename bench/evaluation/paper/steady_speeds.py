"""Fig. 11: one load at several steady speeds, reflected with compensation and without."""

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np

from bench.config.reflected_load import load_current_a, per_kg_a
from bench.config.rig import Rig
from bench.evaluation.paper.row import Row, ids_of
from bench.report import Figure, Line, Points, Section, Table
from bench.store import Experiment, Store, Trial
from compensator.motion.kinetic_friction import FloatArray

STEADY_CYCLES = 40  # that the set point has kept its speed
RPM = 60.0 / (2.0 * pi)
CHANNELS = ("position_rad", "target_rad", "current_a", "current_estimate_a", "current_load_a")


class Stroke(NamedTuple):
    """What one way at one speed reflected, as load at 90 degrees [g].

    Attributes:
        speed_rpm: of the motor; negative backwards.
        compensated_g, uncompensated_g: mean over the steady part.
        errors_g: of the compensated one, row by row.
    """

    speed_rpm: float
    compensated_g: float
    uncompensated_g: float
    errors_g: FloatArray


def fig_11(store: Store, experiment: Experiment) -> Row:
    """The row."""
    trials = store.trials(experiment.id)
    rig, actual_g = Rig.model_validate(experiment.rig), 1e3 * experiment.parameters["load_kg"]
    strokes = [stroke for trial in trials for stroke in _strokes(store, trial, rig)]
    errors_g = np.abs(np.concatenate([stroke.errors_g for stroke in strokes]))
    ours = {
        "compensated_mean_absolute_error_g": float(np.mean(errors_g)),
        "compensated_max_mean_error_g": max(abs(stroke.compensated_g - actual_g) for stroke in strokes),
        "uncompensated_max_mean_error_g": max(abs(stroke.uncompensated_g - actual_g) for stroke in strokes),
    }
    section = Section(
        title="Fig. 11: one load at steady speeds",
        sentences=[
            f"{actual_g:g} g carried through the travel, forwards and backwards. The mean absolute error of the "
            f"compensated load is {ours['compensated_mean_absolute_error_g']:.2f} g over all cycles; the mean of a "
            f"stroke is off by up to {ours['compensated_max_mean_error_g']:.2f} g, uncompensated by up to "
            f"{ours['uncompensated_max_mean_error_g']:.0f} g. The paper shows the same as a figure, without numbers."
        ],
        tables=[_table(strokes)],
        figures=[_figure(strokes, actual_g)],
    )
    return Row("fig-11", section, dict(ours), {}, (experiment.id,), ids_of(trials))


def _strokes(store: Store, trial: Trial, rig: Rig) -> list[Stroke]:
    samples = store.samples(trial.id, CHANNELS)
    truth_a = np.array([load_current_a(float(trial.conditions["load_kg"]), q, rig) for q in samples["position_rad"]])
    measured = samples["current_a"]
    plain_a = np.where(np.isfinite(measured), measured, samples["current_estimate_a"])
    actual_g = 1e3 * float(trial.conditions["load_kg"])
    speed_rpm = float(trial.conditions["held_speed_rad_s"]) * (rig.gear.ratio or 1.0) * RPM
    strokes = []
    for way in (1.0, -1.0):
        rows = _steady(samples["target_rad"], way) & np.isfinite(samples["current_load_a"])
        if np.any(rows):
            both_a = samples["current_load_a"], plain_a
            errors_g, plain_g = (1e3 * (given_a[rows] - truth_a[rows]) / per_kg_a(rig) for given_a in both_a)
            means = actual_g + float(np.mean(errors_g)), actual_g + float(np.mean(plain_g))
            strokes.append(Stroke(way * speed_rpm, *means, errors_g))
    return strokes


def _steady(target_rad: FloatArray, way: float) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Where the set point has moved one way at one speed for a while."""
    step = np.diff(target_rad, prepend=target_rad[0])
    same = (np.abs(np.diff(step, prepend=0.0)) < 1e-9) & (way * step > 1e-9)
    held = np.zeros(len(same), dtype=int)
    for row in range(1, len(same)):
        held[row] = held[row - 1] + 1 if same[row] else 0
    return np.asarray(held >= STEADY_CYCLES)


def _table(strokes: Sequence[Stroke]) -> Table:
    rows = [
        (round(stroke.speed_rpm), round(stroke.compensated_g, 2), round(stroke.uncompensated_g, 1))
        for stroke in strokes
    ]
    return Table("Reflected load [g]", ["motor speed [rpm]#", "compensated#", "uncompensated#"], rows)


def _figure(strokes: Sequence[Stroke], actual_g: float) -> Figure:
    speeds = [stroke.speed_rpm for stroke in strokes]
    return Figure(
        "Reflected load at steady speeds",
        "motor speed [rpm], backwards negative",
        "load [g]",
        [
            Points("uncompensated", speeds, [stroke.uncompensated_g for stroke in strokes]),
            Points("compensated", speeds, [stroke.compensated_g for stroke in strokes]),
            Line("actual", [min(speeds), max(speeds)], [actual_g, actual_g], dashed=True),
        ],
    )
