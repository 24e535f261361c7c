"""`friction-bench store`: what is in it, is it sound, a copy, space, and what is kept how long."""

from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.exit_codes import ExitCode
from bench.cli.output import Json, complain, print_json, say, table

if TYPE_CHECKING:
    from bench.store.upkeep.retention import Expired

app = typer.Typer(no_args_is_help=True)


@app.callback()
def _store() -> None:
    """Look after the store: information, check, repair, backup, vacuum, prune, remove."""


@app.command()
def info(context: typer.Context, as_json: Json = False) -> None:
    """Show what is in the store, and how much room it has."""
    with session_of(context).open_store() as store:
        found = store.upkeep.info()
    if as_json:
        print_json(asdict(found))
        return
    sizes = {
        "size": _mb(found.size_bytes),
        "free on its disk": "-" if found.free_bytes is None else _mb(found.free_bytes),
    }
    facts = {"database": found.where, "schema": found.schema, **sizes, "experiments": found.experiments}
    facts |= {"trials": found.trials, "rows": found.rows, "studies": found.studies, "running": found.running}
    facts |= {"chain entries": found.chain_entries, "chain head": found.chain_head}
    table("Store", ["what", "value"], [*facts.items(), ("oldest experiment", found.oldest_utc)])


@app.command()
def check(
    context: typer.Context,
    head: Annotated[
        str | None, typer.Option(help="Chain head that `store info` told before: the chain has to hold it still.")
    ] = None,
) -> None:
    """Read the whole store, and say what is wrong with it: flipped bits, and records altered or removed past the store.

    Exit code 1 where anything is.
    """
    with session_of(context).open_store() as store:
        problems = store.upkeep.check(head)
    for problem in problems:
        complain(problem)
    if problems:
        raise typer.Exit(ExitCode.NOT_COMPLETED)
    say("the store is sound")


@app.command()
def backup(
    context: typer.Context,
    target: Annotated[str, typer.Argument(help="A file to make, or the URL of an empty database.")],
) -> None:
    """Copy the store while it is in use. The copy is a store: name it with --store to look at it."""
    with session_of(context).open_store() as store:
        store.upkeep.backup(target)
    say(f"the store is in {target}" if "://" not in target else "the store is copied")


@app.command()
def repair(context: typer.Context, target: Annotated[Path, typer.Argument(help="A file to make.")]) -> None:
    """Save what can be read of a damaged SQLite store into a new one, and say what is lost.

    Exit code 1 where anything is. The damaged file stays as it is. Lost rows of a trial are empty, and the trial is
    marked as interrupted.
    """
    from bench.store.upkeep.repair import repair as saved

    lost = saved(session_of(context).store_url(), target)
    for loss in lost:
        complain(loss)
    say(f"{target} holds what could be read; use it with --store")
    if lost:
        raise typer.Exit(ExitCode.NOT_COMPLETED)


@app.command()
def vacuum(context: typer.Context) -> None:
    """Give the space of what was removed back to the disk."""
    with session_of(context).open_store() as store:
        saved = store.upkeep.vacuum()
    say(f"the store is {_mb(max(0, saved))} smaller")


class Record(StrEnum):
    """What can be removed by number."""

    EXPERIMENT = "experiment"
    STUDY = "study"


@app.command()
def remove(
    context: typer.Context,
    what: Annotated[Record, typer.Argument(help="An experiment goes with all its data, a study with its models.")],
    number: Annotated[int, typer.Argument(min=1, help="Its number.")],
    reason: Annotated[str, typer.Option(help="Why; kept in the audit log, with who and when.")],
) -> None:
    """Remove one record for good. Refused while it runs, or while a study or a calibration uses it."""
    from bench.cli.audit_note import note

    if not reason.strip():
        raise typer.BadParameter("the reason is empty; say why it is removed", param_hint="--reason")
    with session_of(context).open_store() as store:
        removed = store.removal.experiment(number) if what is Record.EXPERIMENT else store.removal.study(number)
        note(store, f"store remove {what} {number}", f"removed {removed}: {reason}")
    say(f"{removed} is removed; a file shrinks by: friction-bench store vacuum")


@app.command()
def prune(
    context: typer.Context,
    delete: Annotated[bool, typer.Option("--delete", help="Remove them; without it they are only listed.")] = False,
    used_too: Annotated[
        bool, typer.Option("--used-too", help="Also those that a study or a calibration uses, which then lacks them.")
    ] = False,
    as_json: Json = False,
) -> None:
    """List the experiments that [store.retention] of bench.toml does not keep any more; with --delete, remove them."""
    session = session_of(context)
    settings = session.configuration().store.retention
    with session.open_store() as store:
        found = store.retention.expired(settings)
        chosen = [one.experiment_id for one in found if used_too or not one.used_by]
        audit_entries = 0 if settings.audit_days is None else store.access.audit.count_older(settings.audit_days)
        if delete:
            store.retention.remove(chosen)
            if settings.audit_days is not None:
                store.access.audit.remove_older(settings.audit_days)
    if as_json:
        expired = [asdict(one) for one in found]
        print_json({"deleted": delete, "experiment_ids": chosen, "expired": expired, "audit_entries": audit_entries})
        return
    if not any(settings.model_dump().values()):
        say("[store.retention] of bench.toml sets no limit: everything is kept")
        return
    _show(found)
    verb = "removed" if delete else "to remove with --delete"
    if settings.audit_days is not None:
        say(f"{audit_entries} entries of the audit log {verb}")
    size = sum(one.size_bytes for one in found if one.experiment_id in chosen)
    say(f"{len(chosen)} of {len(found)} {verb}, {_mb(size)} of samples; a file shrinks by: friction-bench store vacuum")


def _show(found: "list[Expired]") -> None:
    rows = [
        (one.experiment_id, one.kind, one.source, one.outcome, one.finished_utc, one.trials, _mb(one.size_bytes),
         ", ".join(one.used_by) or "-")
        for one in found
    ]  # fmt: skip
    table("Expired", ["id#", "kind", "source", "outcome", "finished", "trials#", "samples#", "used by"], rows)


def _mb(size_bytes: int) -> str:
    return f"{size_bytes / 1e6:.1f} MB"
