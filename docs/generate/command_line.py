"""The commands, from typer's own description of them."""

import typer
from typer.cli import get_docs_for_click

from bench.cli.app import CommandGroup, app
from bench.cli.commands import COMMANDS
from bench.cli.exit_codes import HELP
from docs.generate.markdown import code, table

PROGRAM = "friction-bench"
BEGIN = f"""\
# Command line

`{PROGRAM} --help` prints the commands, and `{PROGRAM} COMMAND --help` the options of one. Most commands take
`--json`. Options that hold for every command stand before it: `{PROGRAM} --store lab.sqlite run steps`.

"""


def page() -> str:
    """The page: all commands, what stands before them, then each with its options."""
    group = typer.main.get_command(app)
    assert isinstance(group, CommandGroup)
    context = typer.Context(group, info_name=PROGRAM)
    overview = table(("command", "what it does"), [(code(one.name), one.help) for one in COMMANDS])
    records = [record for one in group.get_params(context) if (record := one.get_help_record(context))]
    options = "\n".join(f"* {code(name)}: {words}" for name, words in records)
    sections = [
        get_docs_for_click(obj=group.loaded(one.name), ctx=context, indent=1, call_prefix=PROGRAM) for one in COMMANDS
    ]
    return f"{BEGIN}{overview}\n## Before every command\n\n{options}\n\n{HELP}\n" + "\n".join(sections)
