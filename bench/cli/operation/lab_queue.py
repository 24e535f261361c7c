"""`friction-bench lab-queue`: experiments for whichever bench of the laboratory fits."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.operation.queue import given_parameters
from bench.cli.output import Json as AsJson
from bench.cli.output import print_json, say, table

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.json_types import Json
    from bench.store import Store
    from bench.store.tables.lab_queue import LabItem, NewLabItem

app = typer.Typer(no_args_is_help=True)
ForBench = Annotated[str, typer.Option("--bench", help="Name of the bench that is to take it; without it, any.")]
ForRig = Annotated[str, typer.Option("--rig", help="Name of the rig that it is for; without it, any.")]
ForTags = Annotated[str, typer.Option("--needs", help="What the bench has to have among its lab_tags: A,B,...")]


@app.callback()
def _lab_queue() -> None:
    """Experiments for whichever bench of the laboratory fits: list, add, campaign, remove. Each is run once."""


@app.command("list")
def list_(
    context: typer.Context,
    ended: Annotated[int, typer.Option(min=0, max=1000, help="How many that came out of it.")] = 5,
    as_json: AsJson = False,
) -> None:
    """Show what waits, which bench has what, and what came out of it last."""
    from bench.store.tables.lab_queue import OPEN

    with _laboratory(session_of(context)) as lab:
        open_, over = lab.lab_queue.items(*OPEN), lab.lab_queue.ended(ended)
    if as_json:
        print_json({"open": [asdict(one) for one in open_], "ended": [asdict(one) for one in over]})
        return
    rows = [(one.id, one.state, one.kind, _asked(one), one.bench or "-", _why(one)) for one in open_]
    table("Queue of the laboratory", ["item#", "state", "kind", "for", "bench", "declined by"], rows)
    if over:
        done = [(one.id, one.state, one.kind, one.bench, one.experiment_id, one.reason) for one in over]
        table("Ended", ["item#", "state", "kind", "bench", "experiment#", "reason"], done)


@app.command()
def add(
    context: typer.Context,
    kind: Annotated[str, typer.Argument(help="Experiment, as for `run`.")],
    parameters: Annotated[list[str] | None, typer.Argument(help="NAME=VALUE each, as for `queue add`.")] = None,
    bench: ForBench = "",
    rig: ForRig = "",
    needs: ForTags = "",
    operator: Annotated[str, typer.Option(help="Who asks for it.")] = "",
    note: Annotated[str, typer.Option(help="Kept with the record.")] = "",
    tags: Annotated[str, typer.Option(help="Words to find it by: A,B,...")] = "",
    as_json: AsJson = False,
) -> None:
    """Add an experiment: a bench that fits takes it when it is free, within its own limits."""
    from bench.store.tables.lab_queue import NewLabItem

    given = cast("Json", given_parameters(kind, parameters or []))
    item = NewLabItem(kind, given, operator, note, _words(tags))
    _add(context, [_for(item, bench, rig, needs)], as_json)


@app.command()
def campaign(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(help="TOML, as for `campaign start`.")],
    bench: ForBench = "",
    rig: ForRig = "",
    needs: ForTags = "",
    as_json: AsJson = False,
) -> None:
    """Add the experiments of a campaign, each for whichever bench fits and is free."""
    from bench.runs.queue.campaign import plan_campaign, read_campaign
    from bench.store.tables.lab_queue import NewLabItem

    found = plan_campaign(read_campaign(file), session_of(context).configuration()).items
    items = [NewLabItem(one.kind, one.parameters, one.operator, one.note, one.tags, one.pace) for one in found]
    _add(context, [_for(one, bench, rig, needs) for one in items], as_json)


@app.command()
def remove(context: typer.Context, item_id: Annotated[int, typer.Argument(min=1, help="Number of the item.")]) -> None:
    """Remove an item that no bench has; one whose bench was lost while it ran is given up."""
    with _laboratory(session_of(context)) as lab:
        lab.lab_queue.remove(item_id)
    say(f"item {item_id} is removed")


def _laboratory(session: BenchSession) -> "Store":
    from bench.store import Store

    places = session.configuration().store
    return Store.open(places.lab_url or places.url)


def _add(context: typer.Context, items: "list[NewLabItem]", as_json: bool) -> None:
    from bench.runs.queue.items import known_item

    checked = [known_item(item) for item in items]
    with _laboratory(session_of(context)) as lab:
        found = lab.lab_queue.add(checked)
    print_json({"item_ids": found}) if as_json else say(f"in the laboratory's queue: {', '.join(map(str, found))}")


def _for(item: "NewLabItem", bench: str, rig: str, needs: str) -> "NewLabItem":
    from dataclasses import replace
    from getpass import getuser

    return replace(item, for_bench=bench, for_rig=rig, for_tags=_words(needs), asked_by=getuser())


def _words(text: str) -> list[str]:
    return [word for word in text.split(",") if word]


def _asked(item: "LabItem") -> str:
    return ", ".join(filter(None, (item.for_bench, item.for_rig, *item.for_tags))) or "any"


def _why(item: "LabItem") -> str:
    return "; ".join(f"{bench}: {why}" for bench, why in item.declined.items())
