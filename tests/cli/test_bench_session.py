"""What a message says of the bench that the global options chose."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from bench.cli.bench_session import BenchSession
from bench.cli.operation import run


@pytest.mark.parametrize(
    ("session", "said"),
    [
        (BenchSession(), "run 'friction-bench doctor --move'"),
        (BenchSession(Path("b.toml")), "run 'friction-bench --config b.toml doctor --move'"),
        (BenchSession(Path("my b.toml"), "s"), "run 'friction-bench --config 'my b.toml' --store s doctor --move'"),
    ],
)
def test_a_command_about_the_drive_names_its_bench(session, said):
    assert session.in_full("run 'friction-bench doctor --move'") == said


def test_a_command_about_the_store_names_it():
    said = "friction-bench --store s token new me, then friction-bench --store s calibrate run"
    assert BenchSession(store="s").in_full("friction-bench token new me, then friction-bench calibrate run") == said


def test_other_commands_stay_as_they_are():
    said = "'friction-bench drives scan' and 'friction-bench serve'"
    assert BenchSession(Path("b.toml")).in_full(said) == said


def test_the_reason_of_a_run_names_its_bench(capsys):
    found: Any = SimpleNamespace(id=1, outcome="failed", reason="first 'friction-bench drive clear-fault'", results={})
    run._report(BenchSession(Path("b.toml")), found, as_json=False)
    assert "first 'friction-bench --config b.toml drive clear-fault'" in " ".join(capsys.readouterr().out.split())
