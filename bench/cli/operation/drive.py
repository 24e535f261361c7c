"""`friction-bench drive`: what a drive says of itself, and the clearing of a fault that it holds on to."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.exit_codes import ExitCode
from bench.cli.output import Json, print_json, say, table

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.control.drive_faults import DriveState

app = typer.Typer(
    no_args_is_help=True,
    help="The drive itself, without an experiment: its state, and the clearing of its fault. Its power stays off.",
)


@app.command()
def state(context: typer.Context, as_json: Json = False) -> None:
    """Connect to the drive and say its state and its fault."""
    from bench.control.drive_faults import read_drives

    found = read_drives(session_of(context).configuration())
    print_json([asdict(one) for one in found]) if as_json else _show(found)


@app.command()
def clear_fault(
    context: typer.Context,
    yes: Annotated[
        bool, typer.Option("--yes", help="The cause is found and removed: clear it, without asking.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show the fault, and clear it once that is confirmed. The power stays off."""
    from bench.control.drive_faults import clear_faults, faults_in_words, read_drives

    session = session_of(context)
    configuration = session.configuration()
    before = read_drives(configuration)
    fault = faults_in_words(before)
    if not as_json:
        _show(before)
    if fault and not (yes or (not as_json and _is_wanted(fault))):
        say(session.in_full("Nothing was cleared. Remove the cause, then: friction-bench drive clear-fault --yes"))
        raise typer.Exit(ExitCode.NOT_COMPLETED)
    after = clear_faults(configuration, fault) if fault else before
    if as_json:
        print_json({"fault": fault, "drives": [asdict(one) for one in after]})
    else:
        say(f"Cleared: {fault}. The power is off." if fault else "There is no fault to clear.")


def _is_wanted(fault: str) -> bool:
    """Ask the person; without one at the terminal the answer is no."""
    try:
        return typer.confirm(f"Clear '{fault}'? Its cause is found and removed, and nobody is in the way", err=True)
    except typer.Abort:
        return False


def _show(states: "tuple[DriveState, ...]") -> None:
    rows = [(one.joint, one.device, one.state or "not told", one.fault or "none") for one in states]
    table("Drive", ["joint", "device", "state", "fault"], rows)
