"""`friction-bench figures`: what the compensator is to reach, and what it reaches."""

import os
from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, print_json, say, table


def figures(
    context: typer.Context,
    seeds: Annotated[int, typer.Option(min=1, help="Seeds of the rig of the paper.")] = 20,
    rigs: Annotated[int, typer.Option(min=0, help="Rigs drawn at random round it.")] = 8,
    first_seed: Annotated[int, typer.Option(min=1, help="The first; another one draws everything anew.")] = 1,
    as_json: Json = False,
) -> None:
    """Measure the compensator's figures over many seeds and rigs, on all cores. Minutes; nothing is kept."""
    from bench.evaluation.figures.measure import measure_figures
    from bench.evaluation.figures.table import COLUMNS

    configuration = session_of(context).configuration()
    rows = measure_figures(
        configuration, seeds, rigs, first_seed, os.cpu_count() or 1, (lambda _: None) if as_json else say
    )
    if as_json:
        print_json([row.to_json() for row in rows])
        return
    table(
        f"{seeds} seeds of rig '{configuration.rig.name}', {rigs} rigs round it", COLUMNS, [row.cells() for row in rows]
    )
    for row in rows:
        if row.note:
            say(f"{row.name}: {row.note}")
