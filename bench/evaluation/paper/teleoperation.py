"""Master and slave, for which the paper builds its compensation: what is reflected, beside the truth."""

from collections.abc import Mapping

import numpy as np

from bench.evaluation.paper.row import Row
from bench.report import Figure, Line, Section, Table
from bench.store import Experiment, Store, Trial
from compensator.motion.kinetic_friction import FloatArray

CHANNELS = ("time_s", "reflected_n_m", "interaction_n_m", "hand_n_m", "position_rad")
COLUMNS = (
    "what is reflected", "error rms [g]#", "largest [g]#", "of the truth, a cycle late [g]#", "beyond 30 ms [g]#",
    "at rest, rms [N m]#", "felt, rms [N m]#", "delay [ms]#", "rise [ms]#", "drag [N m]#", "limit cycle at rest",
    "calm up to force scale#",
)  # fmt: skip


def teleoperation(store: Store, weight: Experiment, wall: Experiment) -> Row:
    """The row: a weight on the slave, and a wall in its way.

    Args:
        store: where the trials are kept.
        weight: teleoperation with a weight, with a search for the stability margin.
        wall: the same against a wall.
    """
    told, leant = weight.results, wall.results
    ours = {
        "compensated_error_rms_g": told.get("compensated_reflected_error_rms_g"),
        "uncompensated_error_rms_g": told.get("raw_reflected_error_rms_g"),
        "error_ratio": told.get("error_ratio"),
        "delay_ms": _ms(told.get("compensated_latency_s")),
        "wall_compensated_error_rms_g": leant.get("compensated_reflected_error_rms_g"),
        "wall_uncompensated_error_rms_g": leant.get("raw_reflected_error_rms_g"),
        "wall_delay_ms": _ms(leant.get("compensated_latency_s")),
        "wall_rise_ms": _ms(leant.get("compensated_rise_s")),
        "wall_largest_error_g": leant.get("compensated_reflected_error_max_g"),
        "wall_largest_error_of_the_truth_g": leant.get("compensated_least_error_max_g"),
        "wall_largest_error_beyond_30_ms_g": leant.get("compensated_late_error_max_g"),
        "wall_uncompensated_largest_error_beyond_30_ms_g": leant.get("raw_late_error_max_g"),
        "drag_n_m": told.get("compensated_drag_n_m"),
        "uncompensated_drag_n_m": told.get("raw_drag_n_m"),
        "wall_drag_n_m": leant.get("compensated_drag_n_m"),
        "wall_uncompensated_drag_n_m": leant.get("raw_drag_n_m"),
        "trials_with_limit_cycle": sum(bool(row.get("limit_cycle")) for row in (*told["rows"], *leant["rows"])),
        "calm_up_to_force_scale": told.get("compensated_stability_margin"),
        "uncompensated_calm_up_to_force_scale": told.get("raw_stability_margin"),
    }
    trials = {"weight": store.trials(weight.id), "wall": store.trials(wall.id)}
    section = Section(
        title="Master and slave",
        sentences=[
            "The operator reaches from angle to angle, the slave follows with "
            f"{1e3 * weight.parameters['load_kg']:g} g, "
            "and its load is reflected to his hand: compensated, and in a trial of its own the whole current. The "
            "truth is the torque that holds up the slave's arm and presses it against a wall. What is felt is the "
            "torque of the hand, the master's own friction and inertia included, which nothing compensates here.",
            "A hit is over within a control cycle: the truth itself, a cycle late and no faster than the master may "
            "change it, errs by what stands beside the largest error. Beyond 30 ms is the largest error that no delay "
            "of up to 30 ms explains. The rise is to half of the greatest jump. Drag is by how much the hand is "
            "resisted more than by the load, over its way; below 0 it is driven on, and the master's own friction has "
            "to take what it is given.",
            "A limit cycle is a joint that turns back at least four times a second by more than 8 encoder counts "
            "while it should rest. The force scale of the load's changes is raised, with a nudge each time, until "
            "there is one; 'at least' where there was none. An arm that hits a wall wedges its gear: then the motor "
            "current does not tell all of the push.",
        ],
        tables=[_table("A weight", weight), _table("A wall", wall)],
        figures=[_figure(store, name, found) for name, found in trials.items()],
    )
    ids = tuple(trial.id for found in trials.values() for trial in found)
    return Row("teleoperation", section, dict(ours), {}, (weight.id, wall.id), ids)


def _ms(value_s: float | None) -> float | None:
    return None if value_s is None else 1e3 * value_s


def _table(title: str, experiment: Experiment) -> Table:
    return Table(title, list(COLUMNS), [_cells(row) for row in experiment.results["rows"]])


def _cells(row: Mapping[str, object]) -> tuple[object, ...]:
    least = "at least " if row.get("stability_margin_at_least") else ""
    calm = row.get("stability_margin")
    return (
        row["reflect"],
        _short(row.get("reflected_error_rms_g")),
        _short(row.get("reflected_error_max_g")),
        _short(row.get("least_error_max_g")),
        _short(row.get("late_error_max_g")),
        _short(row.get("rest_error_rms_n_m")),
        _short(row.get("felt_error_rms_n_m")),
        _short(row.get("latency_s"), 1e3),
        _short(row.get("rise_s"), 1e3),
        _short(row.get("drag_n_m")),
        "yes" if row.get("limit_cycle") else "no",
        "-" if calm is None else f"{least}{_short(calm)}",
    )


def _short(value: object, scale: float = 1.0) -> str:
    return f"{scale * value:.3g}" if isinstance(value, float | int) else "-"


def _figure(store: Store, name: str, trials: list[Trial]) -> Figure:
    """The first trial of each way, over the time since the pair was coupled; the truth of the last of them."""
    firsts = {str(trial.conditions["reflect"]): trial for trial in reversed(trials)}
    lines, truth = [], []
    for way, trial in sorted(firsts.items(), reverse=True):
        rows = _coupled(store.samples(trial.id, CHANNELS))
        at_s = (rows["time_s"] - rows["time_s"][0]).tolist()
        lines.append(Line(way, at_s, rows["reflected_n_m"].tolist()))
        # what a hit does for a moment would hide the rest
        most = 2.0 * float(np.max(np.abs(rows["reflected_n_m"])))
        true = [value if abs(value) <= most else None for value in rows["interaction_n_m"].tolist()]
        truth = [Line("truth", at_s, true, dashed=True)]
    return Figure(f"Reflected to the operator: a {name}", "time [s]", "torque at the slave [N m]", [*lines, *truth])


def _coupled(samples: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    rows = np.flatnonzero(np.isfinite(samples["reflected_n_m"]))
    return {name: values[rows[0] : rows[-1] + 1] for name, values in samples.items()}
