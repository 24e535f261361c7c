"""Benchmarks and other commands that no test calls: what they import is there."""

from importlib import import_module

import pytest

from tests.paths import ROOT

OWN = ("bench", "compensator", "drivers", "sim_backend", "tests")


def commands() -> list[str]:
    """Modules of the tests that are started as `python -m tests...`."""
    files = sorted((ROOT / "tests").rglob("*.py"))
    started = [path for path in files if 'if __name__ == "__main__"' in path.read_text(encoding="utf-8")]
    return [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in started]


@pytest.mark.parametrize("module", commands())
def test_what_a_command_imports_is_there(module: str) -> None:
    try:
        import_module(module)
    except ModuleNotFoundError as error:
        if str(error.name).partition(".")[0] in OWN:
            raise
        pytest.skip(f"{error.name} comes with the extra 'bench'")
