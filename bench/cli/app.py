"""The options that stand before every command, and the entry point of the console script.

The command line lists every command, and imports one when it is used. Typer wants every command at hand before it
prints a list of them; their modules take a second together, so the list is made from the table in `bench.cli.commands`
and a command stands in for its module until it is called.
"""

from functools import cached_property
from pathlib import Path
from pkgutil import resolve_name
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

import bench
from bench.cli.bench_session import BenchSession, session_of
from bench.cli.commands import COMMANDS, CommandEntry
from bench.cli.exit_codes import HELP, errors_as_messages


class ListedCommand(TyperCommand):
    """A command whose module is imported when it is called, or asked for its own help or completion.

    Args:
        entry: where the command is, and its line in the help.
    """

    def __init__(self, entry: CommandEntry) -> None:
        super().__init__(entry.name, short_help=entry.help)
        self._entry = entry

    @cached_property
    def loaded(self) -> Any:
        """The command itself."""
        found = resolve_name(self._entry.place)
        holder = typer.Typer(rich_markup_mode="markdown")
        if isinstance(found, typer.Typer):
            holder.add_typer(found, name=self._entry.name)
        else:
            holder.command(self._entry.name)(found)
        return typer.main.get_group(holder).commands[self._entry.name]

    def make_context(self, info_name: str | None, args: list[str], parent: Any = None, **extra: Any) -> Any:
        """The context of the command itself: whatever is done with it is done with the command, not with this."""
        return self.loaded.make_context(info_name, args, parent=parent, **extra)


class CommandGroup(TyperGroup):
    """The commands of the table, in its order. Errors of every command end here."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        for entry in COMMANDS:
            self.add_command(ListedCommand(entry))

    def loaded(self, name: str) -> Any:
        """The command of that name, with its module imported."""
        found = self.commands[name]
        return found.loaded if isinstance(found, ListedCommand) else found

    def invoke(self, ctx: Any) -> Any:
        """Run the command; errors of ours become a message and an exit code."""

        def in_full(message: str) -> str:
            return session_of(ctx).in_full(message) if ctx.find_root().obj is not None else message

        with errors_as_messages(in_full):
            return super().invoke(ctx)


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
