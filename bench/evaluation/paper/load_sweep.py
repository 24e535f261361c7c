"""Figs 7, 8 and 9 and Table 1: load after load, at angle 0 and at 90 degrees."""

from collections.abc import Sequence
from math import isclose, pi, sqrt

from bench.evaluation.paper.row import FIG_7, FIG_9, TABLE_1_G, Row, ids_of
from bench.report import Figure, Line, Points, Section, Table
from bench.store import Experiment, Trial


def fig_7(experiment: Experiment, trials: Sequence[Trial], grams_per_ma: float) -> Row:
    """Angle 0: gravity has no moment, so the compensated current is to be 0."""
    found = _at(trials, 0.0)
    compensated_ma = max(abs(1e3 * trial.results["load_current_a"]) for trial in found)
    band_ma = max(1e3 * max(abs(trial.results[name]) for name in _BAND) for trial in found)
    ours = {
        "largest_uncompensated_ma": band_ma,
        "largest_compensated_ma": compensated_ma,
        "largest_compensated_g": compensated_ma * grams_per_ma,
    }
    section = Section(
        title="Fig. 7: at angle 0, load after load",
        sentences=[
            "At 0 degrees nothing is to be reflected. Uncompensated, the joint stands with anything within "
            f"{band_ma:.0f} mA either way (paper: about {FIG_7['largest_uncompensated_ma']:.0f} mA), growing with the "
            f"load; compensated, with {compensated_ma:.1f} mA at most, which is {compensated_ma * grams_per_ma:.2f} g "
            "at 90 degrees."
        ],
        figures=[_envelope(found, "Current at angle 0")],
    )
    return Row("fig-7", section, ours, dict(FIG_7), (experiment.id,), ids_of(found))


def fig_9(experiment: Experiment, trials: Sequence[Trial]) -> Row:
    """90 degrees: the compensated current follows the load in a straight line."""
    found = _at(trials, pi / 2)
    ours = {
        "lowest_ma": min(1e3 * trial.results["min_current_a"] for trial in found),
        "highest_ma": max(1e3 * trial.results["max_current_a"] for trial in found),
    }
    section = Section(
        title="Fig. 9: at 90 degrees, load after load",
        sentences=[
            f"At 90 degrees, uncompensated, the current lies anywhere from {ours['lowest_ma']:.0f} to "
            f"{ours['highest_ma']:.0f} mA (paper: {FIG_9['lowest_ma']:.0f} to {FIG_9['highest_ma']:.0f} mA); "
            "compensated, on a straight line."
        ],
        figures=[_envelope(found, "Current at 90 degrees")],
    )
    return Row("fig-9", section, ours, dict(FIG_9), (experiment.id,), ids_of(found))


def table_1(experiment: Experiment, trials: Sequence[Trial]) -> Row:
    """Reflected against actual load at 90 degrees, the paper's beside it."""
    found = _at(trials, pi / 2)
    actual_g = [1e3 * float(trial.conditions["load_kg"]) for trial in found]
    reflected_g = [1e3 * trial.results["reflected_load_kg"] for trial in found]
    errors_g = [there - here for here, there in zip(actual_g, reflected_g, strict=True)]
    paper_g = [reflected - actual for actual, reflected in TABLE_1_G.items()]
    ours, paper = _errors(errors_g), _errors(paper_g)
    rows = [
        (round(actual, 3), _rounded(reflected), _rounded(error), TABLE_1_G.get(round(actual)))
        for actual, reflected, error in zip(actual_g, reflected_g, errors_g, strict=True)
    ]
    titles = {
        "mean_absolute_error_g": "mean absolute", "rms_error_g": "root mean square", "max_error_g": "largest",
    }  # fmt: skip
    section = Section(
        title="Table 1 and Fig. 8: reflected against actual load at 90 degrees",
        sentences=[
            "The table's caption in the paper says angle 0, but a reflected load of 100 g needs a moment arm: Fig. 8, "
            "with the same data, says 90 degrees."
        ],
        tables=[
            Table("Reflected load [g]", ["actual#", "reflected#", "error#", "paper, Table 1#"], rows),
            Table(
                "Error of the reflected load [g]",
                ["", "here#", "paper#"],
                [(title, round(ours[name], 2), round(paper[name], 2)) for name, title in titles.items()],
            ),
        ],
        figures=[
            Figure(
                "Reflected against actual load",
                "actual load [g]",
                "reflected load [g]",
                [
                    Points("here", actual_g, reflected_g),
                    Points("paper, Table 1", list(TABLE_1_G), list(TABLE_1_G.values())),
                    Line("equal", [0.0, 100.0], [0.0, 100.0], dashed=True),
                ],
            ),
            Figure(
                "Error of the reflected load",
                "actual load [g]",
                "error [g]",
                [
                    Points("here", actual_g, errors_g),
                    Points("paper, Table 1", [float(actual) for actual in TABLE_1_G], paper_g),
                    Line("no error", [0.0, 100.0], [0.0, 0.0], dashed=True),
                ],
            ),
        ],
    )
    return Row("table-1", section, dict(ours), dict(paper), (experiment.id,), ids_of(found))


def _rounded(value_g: float) -> float:
    return round(value_g, 2) + 0.0  # never -0


_BAND = ("min_current_a", "max_current_a")


def _at(trials: Sequence[Trial], angle_rad: float) -> list[Trial]:
    """Those at an angle that have an estimate."""
    return [
        trial
        for trial in trials
        if isclose(float(trial.conditions["angle_rad"]), angle_rad) and trial.results["load_current_a"] is not None
    ]


def _envelope(trials: Sequence[Trial], title: str) -> Figure:
    load_g = [1e3 * float(trial.conditions["load_kg"]) for trial in trials]

    def current_ma(name: str) -> list[float]:
        return [1e3 * trial.results[name] for trial in trials]

    return Figure(
        title,
        "load [g]",
        "current [mA]",
        [
            Points("compensated, eq. (9)", load_g, current_ma("load_current_a")),
            Line("uncompensated, highest", load_g, current_ma("max_current_a"), dashed=True),
            Line("uncompensated, lowest", load_g, current_ma("min_current_a"), dashed=True),
        ],
    )


def _errors(errors_g: Sequence[float]) -> dict[str, float]:
    return {
        "mean_absolute_error_g": sum(map(abs, errors_g)) / len(errors_g),
        "rms_error_g": sqrt(sum(error**2 for error in errors_g) / len(errors_g)),
        "max_error_g": max(map(abs, errors_g)),
    }
