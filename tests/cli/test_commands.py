"""The list of commands is printed without importing them, and says what they say of themselves."""

import json
import subprocess
import sys

import pytest
from typer.testing import CliRunner

import bench
from bench.cli.app import ListedCommand, app
from bench.cli.commands import COMMANDS, CommandEntry

HEAVY = {"numpy", "scipy", "numba", "pydantic", "fastapi", "sqlalchemy", "plotly", "httpx", "rich", "can", "canopen"}
IMPORTED = "import json, sys; from bench.cli import main\ntry: main()\nfinally: print(json.dumps([*sys.modules]))"


def imported_by(*words: str) -> set[str]:
    """Names of all modules that a command imports."""
    done = subprocess.run(
        [sys.executable, "-c", IMPORTED, *words], stdout=subprocess.PIPE, text=True, timeout=60, check=True
    )
    return set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_the_help_imports_nothing_heavy(option: str) -> None:
    found = imported_by(option)
    assert not found & HEAVY
    assert not [name for name in found if name.startswith(("bench.cli.operation", "bench.cli.lab", "bench.service"))]


def test_the_modules_are_counted_right() -> None:
    assert imported_by("effects", "--json") >= {"numpy", "bench.cli.lab.effects"}


@pytest.mark.parametrize("entry", COMMANDS, ids=lambda entry: entry.name)
def test_the_line_in_the_list_is_that_of_the_command(entry: CommandEntry) -> None:
    own, _, _ = (ListedCommand(entry).loaded.help or "").partition("\n\n")
    assert " ".join(own.split()) == entry.help


@pytest.mark.parametrize("entry", COMMANDS, ids=lambda entry: entry.name)
def test_every_command_has_a_help_of_its_own(entry: CommandEntry) -> None:
    shown = CliRunner().invoke(app, [entry.name, "--help"])
    assert shown.exit_code == 0
    assert f"Usage: friction-bench {entry.name}" in " ".join(shown.output.split())


def test_a_misspelt_command_is_suggested() -> None:
    shown = CliRunner().invoke(app, ["experimnts"])
    assert shown.exit_code == 2
    assert "Did you mean 'experiments'" in shown.output


def test_the_version_is_that_of_the_package() -> None:
    assert CliRunner().invoke(app, ["--version"]).output == f"friction-bench {bench.__version__}\n"
