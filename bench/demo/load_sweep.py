"""Second part: the load sweep, with the paper's Table 1 beside it (Figs 7, 8, 9)."""

import math
from typing import Any

from bench.configuration import BenchConfiguration
from bench.demo.bench import run_experiment
from bench.report import Figure, Line, Points, Section, Table
from bench.store import Store

PAPER_TABLE_1_G = {
    0: -0.36, 10: 8.90, 20: 19.09, 30: 27.27, 40: 41.63, 50: 51.27, 60: 59.27, 70: 69.27, 80: 81.63, 90: 90.54,
    100: 100.54,
}  # fmt: skip
"""Actual load [g] -> reflected load [g]; Saini et al. 2013, Table 1."""


def load_sweep(configuration: BenchConfiguration, store: Store) -> Section:
    """Run the sweep, and lay its reflected loads beside the paper's."""
    experiment_id = run_experiment(configuration, store, "load-sweep", {})
    results = store.experiment(experiment_id).results
    hanging = [row for row in results["rows"] if row["angle_rad"] == 0.0]
    raised = [row for row in results["rows"] if math.isclose(row["angle_rad"], math.pi / 2)]
    rows, errors = [], []
    for row in raised:
        actual, reflected = 1e3 * row["load_kg"], 1e3 * row["reflected_load_kg"]
        errors.append(reflected - actual)
        rows.append((round(actual), reflected, reflected - actual, PAPER_TABLE_1_G[round(actual)]))
    paper = [reflected - actual for actual, reflected in PAPER_TABLE_1_G.items()]
    return Section(
        title="The load sweep: 0 to 100 g at 0 and 90 degrees",
        tables=[
            Table("Reflected load at 90 degrees [g]", ["actual#", "reflected#", "error#", "paper, Table 1#"], rows),
            Table(
                "Error of the reflected load [g]",
                ["", "here#", "paper#"],
                [
                    ("mean absolute", _mean_absolute(errors), _mean_absolute(paper)),
                    ("root mean square", _rms(errors), _rms(paper)),
                    ("largest", max(map(abs, errors)), max(map(abs, paper))),
                ],
            ),
        ],
        figures=[
            _envelope(hanging, "At 0 degrees (as the paper's Fig. 7)"),
            _envelope(raised, "At 90 degrees (as Fig. 9)"),
        ],
    )


def _envelope(rows: list[dict[str, Any]], title: str) -> Figure:
    load = [1e3 * row["load_kg"] for row in rows]

    def current(name: str) -> list[float]:
        return [1e3 * row[name] for row in rows]

    return Figure(
        title,
        "load [g]",
        "current [mA]",
        [
            Points("compensated, eq. (9)", load, current("load_current_a")),
            Line("uncompensated, highest", load, current("max_current_a"), dashed=True),
            Line("uncompensated, lowest", load, current("min_current_a"), dashed=True),
        ],
    )


def _mean_absolute(errors: list[float]) -> float:
    return sum(map(abs, errors)) / len(errors)


def _rms(errors: list[float]) -> float:
    return math.sqrt(sum(error**2 for error in errors) / len(errors))
