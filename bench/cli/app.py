"""The options that stand before every command, and the entry point of the console script."""

from pathlib import Path
from typing import Annotated

import typer

import bench
from bench.cli.bench_session import BenchSession
from bench.cli.command_group import CommandGroup
from bench.cli.exit_codes import HELP

app = typer.Typer(
    cls=CommandGroup, name="friction-bench", no_args_is_help=True, pretty_exceptions_enable=False, rich_markup_mode=None
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"friction-bench {bench.__version__}")
        raise typer.Exit


@app.callback(epilog=HELP)
def options(
    context: typer.Context,
    config: Annotated[
        Path | None,
        typer.Option(envvar="FRICTION_BENCH_CONFIG", help="bench.toml; without it the simulated bench of the paper."),
    ] = None,
    store: Annotated[
        str | None,
        typer.Option(
            envvar="FRICTION_BENCH_STORE",
            help="SQLite file or database URL; without it friction-bench.sqlite in the working directory.",
        ),
    ] = None,
    log: Annotated[
        str | None,
        typer.Option(
            envvar="FRICTION_BENCH_LOG",
            help="File that gets what happens, one JSON object a line: runs, requests that change something, errors; "
            "- for stderr.",
        ),
    ] = None,
    version: Annotated[  # noqa: ARG001  its callback has done it
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Test bench for a geared servo joint: run experiments, and find the effect that a model is missing.

    Start with `friction-bench demo`, or `friction-bench serve` and open the page that it names.
    """
    context.obj = BenchSession(config, store)
    if log:
        from bench.runs import event_log  # imported when needed: `--help` starts at once

        event_log.begin(log)


def main() -> None:
    """Entry point of the console script."""
    app()
