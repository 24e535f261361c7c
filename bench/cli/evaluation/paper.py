"""`friction-bench paper`: every figure and table of the paper, ours beside it, as one page."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.operation.signals import stoppable_command, stopping_on_signals
from bench.cli.operation.watch import watch
from bench.cli.output import Json, print_json, print_section, say

if TYPE_CHECKING:
    from bench.config.configuration import BenchConfiguration
    from bench.evaluation.paper import Row
    from bench.runs.runner import Runner

TITLE = "friction-bench: the paper, figure by figure"


def paper(
    context: typer.Context,
    report: Annotated[Path, typer.Option(help="Where the HTML report is written.")] = Path("out/paper.html"),
    seed: Annotated[int | None, typer.Option(min=0, help="Of the simulated drive; without it, as configured.")] = None,
    from_store: Annotated[
        bool, typer.Option("--from-store", help="Run nothing: draw the newest trials of the same parameters again.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Run the paper's experiments, and lay our figures and numbers beside its own. Minutes, on a simulated bench."""
    from bench.evaluation.paper import reproduce, summary
    from bench.report import write_html

    session = session_of(context)
    configuration = seeded(session.configuration(), seed)

    def conduct(runner: "Runner") -> None:
        with stopping_on_signals(runner) as received:
            watch(runner, quiet=as_json)
        if received.exit_code is not None:
            raise typer.Exit(received.exit_code)

    with session.open_store() as store, stoppable_command("paper", configuration.name):
        rows = reproduce(configuration, store, from_store, conduct=conduct, show=(lambda _: None) if as_json else _show)
    write_html(report, TITLE, [summary(rows), *(row.with_source() for row in rows)])
    if as_json:
        print_json({"report": str(report), "rows": [row.to_json() for row in rows]})
    else:
        say(f"Report: {report}")


def seeded(configuration: "BenchConfiguration", seed: int | None) -> "BenchConfiguration":
    """The configuration with another seed of its simulated drive."""
    from bench.control.drive_factory import seed_of, with_seed
    from bench.errors import ConfigurationError

    if seed is None:
        return configuration
    if seed_of(configuration) is None:
        raise ConfigurationError("--seed is for a simulated drive; the drive of this bench has none")
    return with_seed(configuration, seed)


def _show(row: "Row") -> None:
    print_section(row.with_source())
