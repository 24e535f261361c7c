"""Figs 4 and 10: the same step again and again, and the current that holds the joint afterwards."""

from collections.abc import Sequence

from bench.evaluation.paper.row import FIG_4, Row, ids_of
from bench.report import Figure, Line, Points, Section, Table
from bench.store import Experiment, Trial


def fig_4(experiment: Experiment, trials: Sequence[Trial]) -> Row:
    """The spread of the steady current, compensated and not."""
    count = [float(trial.conditions["repeat"]) for trial in trials]
    plain_ma = [1e3 * trial.results["steady_current_a"] for trial in trials]
    found = [trial for trial in trials if trial.results["load_current_a"] is not None]
    load_ma = [1e3 * trial.results["load_current_a"] for trial in found]
    load_g = [1e3 * trial.results["reflected_load_kg"] for trial in found]
    spread_ma, left_ma = max(plain_ma) - min(plain_ma), max(load_ma) - min(load_ma)
    ours = {
        "lowest_ma": min(plain_ma),
        "highest_ma": max(plain_ma),
        "spread_ma": spread_ma,
        "compensated_spread_ma": left_ma,
        "compensated_spread_g": max(load_g) - min(load_g),
        "spread_ratio": spread_ma / left_ma if left_ma else None,
        "without_estimate": len(trials) - len(found),
    }
    weight_g = 1e3 * experiment.parameters["load_kg"]
    section = Section(
        title=f"Fig. 4: the same step {len(trials)} times, 0 to 90 degrees, {weight_g:g} g",
        sentences=[
            "Each step approaches at another speed. Friction holds the joint wherever the servo lets it rest, so "
            "the steady current differs from step to step. The zero-speed search finds the load's share: its spread is "
            f"{spread_ma / left_ma:.0f} times smaller, {ours['compensated_spread_g']:.1f} g of load."
        ],
        tables=[
            Table(
                "Steady current [mA]",
                ["current", "lowest#", "highest#", "spread#", "paper, Fig. 4 (about)"],
                [
                    ("uncompensated", min(plain_ma), max(plain_ma), spread_ma, "100 to 850"),
                    ("compensated", min(load_ma), max(load_ma), left_ma, "not given"),
                ],
            )
        ],
        figures=[
            Figure(
                "Steady current of each step",
                "step",
                "current [mA]",
                [
                    Points("uncompensated", count, plain_ma),
                    Points("compensated", [float(trial.conditions["repeat"]) for trial in found], load_ma),
                ],
            )
        ],
    )
    return Row("fig-4", section, ours, dict(FIG_4), (experiment.id,), ids_of(trials))


def fig_10(experiment: Experiment, trials: Sequence[Trial], grams_per_ma: float) -> Row:
    """One load: what was hung, what is reflected with and without compensation."""
    actual_g = 1e3 * experiment.parameters["load_kg"]
    found = [trial for trial in trials if trial.results["reflected_load_kg"] is not None]
    count = [float(trial.conditions["repeat"]) for trial in trials]
    plain_g = [1e3 * trial.results["steady_current_a"] * grams_per_ma for trial in trials]
    load_g = [1e3 * trial.results["reflected_load_kg"] for trial in found]
    errors_g = [abs(value - actual_g) for value in load_g]
    ours = {
        "compensated_mean_absolute_error_g": sum(errors_g) / len(errors_g),
        "compensated_max_error_g": max(errors_g),
        "uncompensated_max_error_g": max(abs(value - actual_g) for value in plain_g),
    }
    section = Section(
        title=f"Fig. 10: one load at rest, {len(trials)} trials",
        sentences=[
            f"{actual_g:g} g at 90 degrees. Compensated, the reflected load is off by {max(errors_g):.2f} g at most; "
            f"uncompensated by up to {ours['uncompensated_max_error_g']:.0f} g, anywhere within the friction band. The "
            "paper shows the same as a figure, without numbers."
        ],
        figures=[
            Figure(
                "Reflected load of each trial",
                "trial",
                "load [g]",
                [
                    Points("uncompensated", count, plain_g),
                    Points("compensated", [float(trial.conditions["repeat"]) for trial in found], load_g),
                    Line("actual", [count[0], count[-1]], [actual_g, actual_g], dashed=True),
                ],
            )
        ],
    )
    return Row("fig-10", section, ours, {}, (experiment.id,), ids_of(trials))
