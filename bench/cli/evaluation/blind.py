"""`friction-bench blind`: how often the lab is right, on joints that it knows nothing of."""

import math
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.evaluation.cores import Cluster, Workers, progress
from bench.cli.output import Json, complain, print_json, say, table

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.evaluation.blind.calibration import Came
    from bench.evaluation.blind.figures import Figure
    from bench.evaluation.blind.result import Result


class Plant(StrEnum):
    """Which simulator the joints are of: the bench's own, or the second plant, which was written without knowing it."""

    OWN = "own"
    SECOND = "second"


def blind(
    plants: Annotated[int, typer.Option(min=1, help="Rounds; each asks fifteen items of fifteen joints.")] = 20,
    seed: Annotated[int, typer.Option(min=0, help="Draws joints, mechanisms and noise.")] = 1,
    results: Annotated[
        Path | None,
        typer.Option(help="Keep the results here, one a line; a run that was ended goes on from there."),
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(help="Ask this family of items alone, for instance complete; repeatable.")
    ] = None,
    plant: Annotated[Plant, typer.Option(help="Simulator that the joints are drawn from.")] = Plant.OWN,
    workers: Workers = None,
    cluster: Cluster = None,
    html: Annotated[Path | None, typer.Option(help="Write tables and calibration plots to this page, too.")] = None,
    as_json: Json = False,
) -> None:
    """Draw joints, hide mechanisms or nothing in them, record them, and ask the model lab what is missing.

    The lab sees recordings and rig alone. What is asked stands beside what was measured.
    """
    from bench.evaluation.blind.items import items_of
    from bench.evaluation.blind.judge import judge
    from bench.evaluation.blind.pool import run_items
    from bench.evaluation.blind.second_judge import judge_second, second_items_of

    draw, ask = (second_items_of, judge_second) if plant is Plant.SECOND else (items_of, judge)
    done = run_items(draw(seed, plants, only or ()), results, progress, workers, cluster, ask)
    if html is not None:
        from bench.evaluation.blind.pictures import write_page

        chosen = "".join(f" --only {name}" for name in only or ())
        other = "" if plant is Plant.OWN else f" --plant {plant}"
        write_page(html, done, f"friction-bench blind{other} --plants {plants} --seed {seed}{chosen}")
    if as_json:
        print_json(_as_json(done, seed, plants))
    else:
        _print(done)


def _as_json(results: "list[Result]", seed: int, plants: int) -> dict[str, object]:
    from dataclasses import asdict

    from bench.evaluation.blind.calibration import (
        came_of_prediction,
        named_by_prediction,
        names_by_detectability,
        p_values,
    )
    from bench.evaluation.blind.confusion import confusions, rival_figures
    from bench.evaluation.blind.figures import figures

    stated = (*p_values(results), *names_by_detectability(results), *named_by_prediction(results))
    return {
        "seed": seed,
        "plants": plants,
        "figures": [asdict(one) for one in figures(results)],
        "confusion": [asdict(one) for one in confusions(results)],
        "calibration": [asdict(one) for one in stated],
        "predictions": [asdict(one) for one in came_of_prediction(results)],
        "rivals": [asdict(one) for one in rival_figures(results)],
        "items": [one.to_json() for one in results],
    }


def _print(results: "list[Result]") -> None:
    from bench.evaluation.blind.confusion import confusions, rival_figures
    from bench.evaluation.blind.figures import figures
    from bench.evaluation.blind.pictures import RIVAL_COLUMNS

    rows = [(one.what, one.asked, _measured(one), one.items, _reached(one)) for one in figures(results)]
    table("Asked and measured", ["what", "asked", "measured (95 %)#", "items#", "reached"], rows)
    table(
        "What is answered to what",
        ["hidden", "in the catalogue", "items#", "d' >= 6#", "of these right#", "first answers, flags not counted"],
        [
            (
                one.truth,
                one.name or "-",
                one.items,
                one.due,
                one.right_of_due,
                ", ".join(f"{name} {count}" for name, count in one.answers),
            )
            for one in confusions(results)
        ],
    )
    table(
        "The same items, the same columns",
        RIVAL_COLUMNS,
        [(one.name, _percent(one.false_alarm), _percent(one.named_first)) for one in rival_figures(results)],
    )
    _print_calibration(results)
    seconds = sorted(one.seconds for one in results if one.answer is not None)
    if seconds:
        say(f"a diagnosis took {seconds[len(seconds) // 2]:.2g} s of one core, half of them less")
    for one in results:
        if one.refusal:
            complain(f"item {one.key}: {one.refusal}")


def _print_calibration(results: "list[Result]") -> None:
    from bench.evaluation.blind.calibration import (
        came_of_prediction,
        named_by_prediction,
        names_by_detectability,
        p_values,
    )

    rows = [(one.what, one.items, _percent(one.observed)) for one in p_values(results)]
    table("p of complete models: stated and observed", ["stated", "items#", "observed#"], rows)
    rows = [(one.what, one.items, _percent(one.observed)) for one in names_by_detectability(results)]
    table("One effect hidden: named first, by d'", ["d'", "items#", "named first#"], rows)
    rows = [(one.what, one.items, _percent(one.observed)) for one in named_by_prediction(results)]
    table("Suggested trials recorded: named alone, by predicted d'", ["d'", "items#", "named alone#"], rows)
    came = [(one.what, one.rounds, _number(one.median), _quartiles(one)) for one in came_of_prediction(results)]
    table("d' of each round: predicted, and as it came", ["predicted", "rounds#", "median#", "quartiles#"], came)


def _quartiles(one: "Came") -> str:
    return "-" if one.rounds == 0 else f"{one.low:.1f} .. {one.high:.1f}"


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.1f}"


def _reached(one: "Figure") -> str:
    return ("yes" if one.reached else "no") if one.is_told else "-"


def _measured(one: "Figure") -> str:
    if math.isnan(one.measured):
        return "not measured"
    if math.isnan(one.low):
        return f"{one.measured:.3g}"
    if not one.is_share:
        return f"{one.measured:.3g} ({one.low:.3g} .. {one.high:.3g})"
    return f"{one.measured:.1%} ({one.low:.1%} .. {one.high:.1%})"


def _percent(share: float) -> str:
    return "-" if math.isnan(share) else f"{share:.1%}"
