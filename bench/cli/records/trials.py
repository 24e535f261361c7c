"""`friction-bench trials` and `trial`: what was recorded."""

from pathlib import Path
from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, conditions, print_json, say, table, write_whole


def trials(
    context: typer.Context,
    experiment: Annotated[int | None, typer.Option(help="Only trials of this experiment.")] = None,
    kind: Annotated[str | None, typer.Option(help="Only this kind.")] = None,
    outcome: Annotated[str | None, typer.Option(help="Only this outcome.")] = None,
    limit: Annotated[int, typer.Option(min=1, help="How many.")] = 200,
    as_json: Json = False,
) -> None:
    """List trials in the order in which they were made."""
    with session_of(context).open_store() as store:
        if experiment is not None:
            store.experiment(experiment)  # says so where there is none
        found = store.trials(experiment, kind, outcome, limit=limit)
    if as_json:
        from bench.service.records import Trial  # here: its models take longer to make than a list to print

        print_json([Trial.model_validate(one) for one in found])
        return
    rows = [
        (one.id, one.experiment_id, one.name, one.kind, conditions(one.conditions), one.rows, one.outcome, one.reason)
        for one in found
    ]
    table("Trials", ["id#", "experiment#", "name", "kind", "conditions", "rows#", "outcome", "reason"], rows)


def trial(
    context: typer.Context,
    trial_id: Annotated[int, typer.Argument(metavar="ID", help="Number of the trial.")],
    csv: Annotated[bool, typer.Option("--csv", help="Print all its samples as CSV and nothing else.")] = False,
    parquet: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write all its samples to a Parquet file instead.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Show one trial: conditions, results, events; or all its samples as CSV or Parquet."""
    from bench.recording_set import csv_chunks, parquet_chunks, stream_of_trial

    with session_of(context).open_store() as store:
        found = store.trial(trial_id)
        if csv:
            for chunk in csv_chunks(stream_of_trial(store, found)):
                typer.echo(chunk, nl=False)
            return
        if parquet is not None:
            write_whole(parquet, parquet_chunks([stream_of_trial(store, found)]))
            say(f"trial {found.id} is in {parquet}")
            return
        events = store.events(trial_id)
    if as_json:
        from bench.service.records import Trial

        print_json({**dict(Trial.model_validate(found)), "events": [event._asdict() for event in events]})
        return
    facts = {"experiment": found.experiment_id, "kind": found.kind, "outcome": found.outcome, "reason": found.reason}
    facts |= {"rows": found.rows, "channels": ", ".join(found.channels), **found.conditions}
    table(f"Trial {trial_id}: {found.name}", ["what", "value"], facts.items())
    if found.results:
        table("Results", ["what", "value"], found.results.items())
    if events:
        table("Events", ["time [s]#", "event", "detail"], events)
