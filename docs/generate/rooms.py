"""The rooms of the house: every package with what its docstring says of it, and the walls that are checked."""

import importlib
import pkgutil
import tomllib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from docs.generate.markdown import code, table

ROOT = Path(__file__).parents[2]
TOP = ("bench", "drivers", "compensator", "sim_backend")


def rooms() -> str:
    """A table for each top-level package."""
    return "\n".join(f"### {code(name)}\n\n{table(('room', 'what it is for'), _rooms(name))}" for name in TOP)


def walls() -> str:
    """The contracts that `make check` holds, by name."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    return "\n".join(f"- {one['name']}" for one in project["tool"]["importlinter"]["contracts"]) + "\n"


def _rooms(name: str) -> Iterator[tuple[str, str]]:
    module = importlib.import_module(name)
    yield code(name), _words(module)
    for found in pkgutil.walk_packages(module.__path__, f"{name}."):
        if found.ispkg and not found.name.endswith(".versions"):
            yield code(found.name), _words(importlib.import_module(found.name))


def _words(module: ModuleType) -> str:
    """What a package says of itself, up to the first line that is code or an import."""
    paragraphs = (module.__doc__ or "").strip().split("\n\n")
    return " ".join(one for one in paragraphs[:2] if not one.startswith((" ", "from ", "import ")))
