"""`friction-bench campaign`: many experiments over a grid of parameters, from a TOML file."""

from pathlib import Path
from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.operation.service import DEFAULT_URL, Url, ask
from bench.cli.output import Json, print_json, say, table

app = typer.Typer(no_args_is_help=True)
File = Annotated[Path, typer.Argument(help="TOML: name, kind, [parameters], [grid], repeats, order, seed, tags.")]


@app.callback()
def _campaign() -> None:
    """Experiments over every combination of some parameters: plan, start."""


@app.command()
def plan(context: typer.Context, file: File, as_json: Json = False) -> None:
    """Show what it comes to on this bench: order, duration, load changes. Nothing moves; no service is needed."""
    from bench.runs.queue.campaign import plan_campaign, read_campaign

    campaign = read_campaign(file)
    found = plan_campaign(campaign, session_of(context).configuration())
    if as_json:
        from bench.service.routes.queue_models import plan_of

        print_json(plan_of(campaign.name, found).model_dump())
        return
    rows = [
        (number, item.kind, ", ".join(f"{name}={value}" for name, value in item.parameters.items()), item.duration_s)
        for number, item in enumerate(found.items, 1)
    ]
    table(campaign.name, ["#", "kind", "parameters", "takes [s]#"], rows)
    say(f"{len(rows)} experiments, about {found.duration_s / 60.0:.1f} min, {found.load_changes} load changes")


@app.command()
def start(context: typer.Context, file: File, url: Url = DEFAULT_URL, as_json: Json = False) -> None:
    """Put it into the queue of a running service: all of its experiments, or none."""
    from bench.runs.queue.campaign import read_campaign

    body = read_campaign(file).model_dump(mode="json")
    found = ask(session_of(context), "POST", url, "/campaigns", body)
    if as_json:
        print_json(found)
        return
    minutes = found["duration_s"] / 60.0
    say(f"campaign '{found['name']}': {len(found['item_ids'])} experiments in the queue, about {minutes:.1f} min")
