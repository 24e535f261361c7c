"""A run of the blind benchmark as a page: asked and measured, the rivals, and stated against observed."""

from collections.abc import Sequence
from pathlib import Path

from bench.evaluation.blind.calibration import (
    Came,
    Stated,
    came_of_prediction,
    named_by_prediction,
    names_by_detectability,
    p_values,
)
from bench.evaluation.blind.confusion import rival_figures
from bench.evaluation.blind.figures import figures
from bench.evaluation.blind.result import Result
from bench.json_types import known
from bench.report.html import write_html
from bench.report.section import Figure, Line, Points, Section, Table

RIVAL_COLUMNS = ("method", "false alarms by first answer, flags not counted#", "named first where d' >= 6#")


def write_page(path: Path, results: Sequence[Result], command: str) -> None:
    """Write the page of a run; `command` is what it was had by."""
    write_html(path, "Blind benchmark of the model lab", sections_of(results, command))


def sections_of(results: Sequence[Result], command: str) -> list[Section]:
    """What the page is made of."""
    found, by_d_prime = p_values(results), names_by_detectability(results)
    settled, came = named_by_prediction(results), came_of_prediction(results)
    measured = [
        (
            one.what, one.asked, known(one.measured), known(one.low), known(one.high), one.items,
            one.reached if one.is_told else None,
        )
        for one in figures(results)
    ]  # fmt: skip
    methods = [(one.name, known(one.false_alarm), known(one.named_first)) for one in rival_figures(results)]
    columns = ("what", "asked", "measured#", "from#", "to#", "items#", "reached")
    return [
        Section("Asked and measured", (command,), (Table("95 % intervals", columns, measured),)),
        Section(
            "The same items, the same columns",
            tables=(Table("Methods", RIVAL_COLUMNS, methods),),
        ),
        Section("Stated and observed", tables=(_table(found), _table(by_d_prime)), figures=_plots(found, by_d_prime)),
        Section("Predicted, and as it came", tables=(_table(settled), _came_table(came)), figures=[_came_plot(came)]),
    ]


def _plots(found: Sequence[Stated], by_d_prime: Sequence[Stated]) -> list[Figure]:
    honest = Line("as stated", [0.0, 0.5], [0.0, 0.5], dashed=True)
    return [
        Figure(
            "p of complete models", "stated p", "share of complete models with so small a p", (honest, _points(found))
        ),
        Figure("One effect hidden", "d', from", "share named first", (_points(by_d_prime),)),
    ]


def _came_plot(rows: Sequence[Came]) -> Figure:
    seen = [one for one in rows if one.rounds]
    low, high = [one.low for one in seen], [one.high for one in seen]
    points = Points("came: median, quartiles", [one.at for one in seen], [one.median for one in seen], low, high)
    most = max((one.at for one in seen), default=1.0)
    honest = Line("as predicted", [0.0, most], [0.0, most], dashed=True)
    return Figure("Suggested trials, each round", "predicted d'", "d' as it came", (honest, points))


def _came_table(rows: Sequence[Came]) -> Table:
    return Table(
        "d' of each round",
        ("predicted", "rounds#", "median#", "quartile#", "quartile#"),
        [(one.what, one.rounds, known(one.median), known(one.low), known(one.high)) for one in rows],
    )


def _points(rows: Sequence[Stated]) -> Points:
    seen = [one for one in rows if one.items]
    return Points(
        "observed, 95 % interval",
        [one.at for one in seen],
        [one.observed for one in seen],
        [one.low for one in seen],
        [one.high for one in seen],
    )


def _table(rows: Sequence[Stated]) -> Table:
    return Table(
        "As numbers",
        ("stated", "items#", "observed#", "from#", "to#"),
        [(one.what, one.items, known(one.observed), known(one.low), known(one.high)) for one in rows],
    )
