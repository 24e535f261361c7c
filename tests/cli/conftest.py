from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from bench.cli.app import app

Command = Callable[..., Result]


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Command:
    """Runs `friction-bench ...` in an empty working directory."""
    for name in ("CONFIG", "STORE", "URL", "TOKEN"):
        monkeypatch.delenv(f"FRICTION_BENCH_{name}", raising=False)
    monkeypatch.chdir(tmp_path)
    return lambda *words: CliRunner().invoke(app, [str(word) for word in words])
