"""`friction-bench rivals`: ways to take friction out of a motor current, side by side."""

from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, print_json, say, table


def rivals(
    context: typer.Context,
    seeds: Annotated[int, typer.Option(min=1, max=100, help="How many seeds of the simulated drive.")] = 3,
    as_json: Json = False,
) -> None:
    """Compare ways of compensation on the same samples of the simulated joint, with free play and without."""
    from bench.evaluation.rivals import compare, numbers_of, section_of

    found = compare(session_of(context).configuration(), range(1, seeds + 1), (lambda _: None) if as_json else say)
    if as_json:
        print_json({"seeds": list(range(1, seeds + 1)), "rivals": numbers_of(found)})
        return
    section = section_of(found, seeds)
    for sentence in section.sentences:
        say(sentence)
    for one in section.tables:
        table(one.title, one.columns, one.rows)
