"""Benchmarks and other commands that no test calls: what they import is there."""

import subprocess
import sys

from tests.paths import ROOT

OWN = ("bench", "compensator", "drivers", "sim_backend", "tests")

# in a process of its own: some replace clocks and threads as they are imported
PROGRAM = """
import sys
from importlib import import_module

for module in sys.argv[1:]:
    try:
        import_module(module)
    except ModuleNotFoundError as error:
        print(module, "needs", error.name)
"""


def commands() -> list[str]:
    """Modules of the tests that are started as `python -m tests...`."""
    files = sorted((ROOT / "tests").rglob("*.py"))
    started = [path for path in files if 'if __name__ == "__main__"' in path.read_text(encoding="utf-8")]
    return [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in started]


def test_what_commands_import_is_there() -> None:
    """What comes with the extra 'bench' may be missing; modules of the project may not."""
    words = [sys.executable, "-c", PROGRAM, *commands()]
    ended = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    missing = [line for line in ended.stdout.splitlines() if line.partition(" needs ")[2].partition(".")[0] in OWN]
    assert missing == []
