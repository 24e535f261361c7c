"""`friction-bench experiments`: what has been run."""

from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, print_json, table


def experiments(
    context: typer.Context,
    limit: Annotated[int, typer.Option(min=1, help="How many, newest first.")] = 20,
    kind: Annotated[str | None, typer.Option(help="Only this kind.")] = None,
    outcome: Annotated[str | None, typer.Option(help="Only this outcome.")] = None,
    tag: Annotated[str | None, typer.Option(help="Only those with this tag.")] = None,
    as_json: Json = False,
) -> None:
    """List what has been run or imported, newest first."""
    with session_of(context).open_store() as store:
        found = store.experiments(kind=kind, outcome=outcome, tag=tag, limit=limit)
    if as_json:
        from bench.service.records import Experiment

        print_json([Experiment.model_validate(one).model_dump(mode="json") for one in found])
        return
    rows = [
        (one.id, one.kind, one.source, one.started_utc, one.outcome, one.reason, one.note or one.parameters.get("name"),
         ", ".join(one.tags))
        for one in found
    ]  # fmt: skip
    table("Experiments", ["id#", "kind", "source", "started", "outcome", "reason", "note", "tags"], rows)
