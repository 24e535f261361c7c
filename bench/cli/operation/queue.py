"""`friction-bench queue`: the queue of a service that is running."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bench.cli.bench_session import session_of
from bench.cli.operation.service import DEFAULT_URL, Url, ask
from bench.cli.output import Json, print_json, say, table

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.json_types import Values

app = typer.Typer(no_args_is_help=True)
ItemId = Annotated[int, typer.Argument(min=1, help="Number of the item.")]


@app.callback()
def _queue() -> None:
    """Experiments one after the other, on a running service: list, add, move, remove, clear, pause, resume."""


@app.command("list")
def list_(
    context: typer.Context,
    ended: Annotated[int, typer.Option(min=0, max=1000, help="How many that came out of it.")] = 5,
    url: Url = DEFAULT_URL,
    as_json: Json = False,
) -> None:
    """Show what waits, what runs, and how long it takes."""
    found = ask(session_of(context), "GET", url, f"/queue?ended={ended}")
    print_json(found) if as_json else show(found)


@app.command()
def add(
    context: typer.Context,
    kind: Annotated[str, typer.Argument(help="Experiment, as for `run`.")],
    parameters: Annotated[
        list[str] | None, typer.Argument(help="NAME=VALUE each, as in the experiment's options; lists: A,B,...")
    ] = None,
    operator: Annotated[str, typer.Option(help="Who stands at the bench.")] = "",
    note: Annotated[str, typer.Option(help="Kept with the record.")] = "",
    tags: Annotated[str, typer.Option(help="Words to find it by: A,B,...")] = "",
    url: Url = DEFAULT_URL,
    as_json: Json = False,
) -> None:
    """Add an experiment: it starts when it is its turn, at once where nothing is before it."""
    item = {
        "kind": kind,
        "parameters": given_parameters(kind, parameters or []),
        "operator": operator,
        "note": note,
        "tags": [tag for tag in tags.split(",") if tag],
    }
    found = ask(session_of(context), "POST", url, "/queue", {"items": [item]})
    print_json(found) if as_json else say(f"item {found['item_ids'][0]} is in the queue")


@app.command()
def move(
    context: typer.Context,
    item_id: ItemId,
    position: Annotated[int, typer.Argument(min=1, help="Its new place among those that wait; 1 is next.")],
    url: Url = DEFAULT_URL,
) -> None:
    """Move an item that waits."""
    ask(session_of(context), "PATCH", url, f"/queue/{item_id}", {"position": position - 1})
    say(f"item {item_id} is moved")


@app.command()
def remove(context: typer.Context, item_id: ItemId, url: Url = DEFAULT_URL) -> None:
    """Remove an item that waits."""
    ask(session_of(context), "DELETE", url, f"/queue/{item_id}")
    say(f"item {item_id} is removed")


@app.command()
def clear(context: typer.Context, url: Url = DEFAULT_URL) -> None:
    """Remove all that waits."""
    found = ask(session_of(context), "DELETE", url, "/queue")
    say(f"{found['removed']} removed")


@app.command()
def pause(context: typer.Context, url: Url = DEFAULT_URL, as_json: Json = False) -> None:
    """Stand still after the trial that runs, with the power off, and start nothing more."""
    found = ask(session_of(context), "POST", url, "/queue/pause")
    print_json(found) if as_json else say(f"the queue is {found['state']}")


@app.command()
def resume(context: typer.Context, url: Url = DEFAULT_URL, as_json: Json = False) -> None:
    """Go on after a pause, a stop or a failure: the joint moves."""
    found = ask(session_of(context), "POST", url, "/queue/resume")
    print_json(found) if as_json else say(f"the queue is {found['state']}")


def show(found: dict[str, Any]) -> None:
    """The queue as tables."""
    why = f": {found['reason']}" if found["reason"] else ""
    say(f"{found['state']}{why}; {_minutes(found['left_s'])} left, {found['load_changes']} load changes")
    items = [*([found["running"]] if found["running"] else []), *found["waiting"]]
    table("Queue", ["item#", "state", "kind", "parameters", "takes#", "tags"], map(_row, items))
    if found["next_offset"] is not None:
        say(f"these are the first {len(found['waiting'])} of {found['waiting_count']} that wait")
    if found["ended"]:
        rows = [(*_row(item)[:3], item["experiment_id"], item["reason"]) for item in found["ended"]]
        table("Ended", ["item#", "state", "kind", "experiment#", "reason"], rows)


def _row(item: dict[str, Any]) -> Sequence[object]:
    parameters = ", ".join(f"{name}={value}" for name, value in item["parameters"].items())
    tags = ", ".join(item["tags"])
    return item["item_id"], item["state"], item["kind"], parameters, _minutes(item["duration_s"]), tags


def _minutes(seconds: float) -> str:
    return f"{seconds / 60.0:.1f} min" if seconds >= 60.0 else f"{seconds:.0f} s"


def given_parameters(name: str, words: list[str]) -> "Values":
    """NAME=VALUE words as the parameters of a kind."""
    from bench.cli.parameters import given
    from bench.experiments.registry import find_kind

    kind = find_kind(name)
    known = kind.parameters.model_json_schema().get("properties", {})
    found: dict[str, list[str]] = {}
    for word in words:
        key, equals, value = word.partition("=")
        key = key.removeprefix("--").replace("-", "_")
        if not equals or key not in known:
            raise typer.BadParameter(f"found '{word}'; wanted NAME=VALUE, NAME one of {', '.join(known)}")
        found.setdefault(key, []).append(value)
    return given(kind, found)
