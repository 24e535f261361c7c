"""The first trial of a process: what it computes with is there before the first cycle."""

import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import sys
from bench.config.configuration import default_configuration
from bench.control.loop import ControlLoop
from bench.runs.runner import Runner
from bench.store import Store

whole = ControlLoop.run

def watched(loop, *arguments):
    before = set(sys.modules)
    try:
        return whole(loop, *arguments)
    finally:
        # the simulated drive brings its compiler, and with it scipy.linalg, before the first cycle
        used = ("scipy.special", "scipy.optimize", "scipy.stats", "scipy.signal", "scipy.interpolate")
        print("imported:", *sorted(name for name in set(sys.modules) - before if name.startswith(used)))

ControlLoop.run = watched
with Store.open(f"sqlite:///{sys.argv[1]}/bench.sqlite") as store:
    runner = Runner(default_configuration(), store)
    runner.start(sys.argv[2], {}, pace="fast")
    runner.wait()
    print(runner.status().outcome)
    runner.close()
"""


@pytest.mark.parametrize("kind", ["steps", "load-sweep"])
def test_the_loop_imports_nothing_that_it_computes_with(tmp_path: Path, kind: str) -> None:
    """An import of 40 ms is eight cycles in which the drive goes on with the last command."""
    words = [sys.executable, "-c", PROGRAM, str(tmp_path), kind]
    told = subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()
    assert told[-1] == "completed"
    assert [line for line in told[:-1] if line != "imported:"] == []
