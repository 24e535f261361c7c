"""Runs the public commands on measured recordings, which are not part of the repository."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from tests.paths import EXAMPLES, measured


class Commands:
    """`friction-bench` with a store of its own."""

    def __init__(self, folder: Path) -> None:
        self._store = f"sqlite:///{folder / 'bench.sqlite'}"

    def __call__(self, *arguments: object) -> dict:
        """Run one command with --json, and return what it printed."""
        words = [str(argument) for argument in arguments]
        ran = CliRunner().invoke(app, ["--store", self._store, *words, "--json"])
        assert ran.exit_code == 0, f"{ran.output}{ran.stderr}"
        return json.loads(ran.stdout)

    def import_set(self, name: str) -> int:
        """Import a measured set with its rig and mapping of `examples/`; skip where it is absent."""
        example = EXAMPLES / name
        rig, mapping = example / "rig.toml", example / "mapping.toml"
        found = self("import", measured(name), "--rig", rig, "--mapping", mapping, "--name", name)
        return found["experiment_id"]


@pytest.fixture
def command(tmp_path):
    return Commands(tmp_path)
