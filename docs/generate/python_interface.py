"""The Python interface: which rooms are public, and a page for each; Sphinx fills it from the docstrings."""

import importlib
import pkgutil
from types import ModuleType

from docs.generate.markdown import code, table

FOLDER = "python"
PUBLIC = (
    "bench.client",
    "bench.study",
    "bench.recording_set",
    "bench.calibration",
    "bench.store",
    "drivers.contract",
    "drivers.errors",
    "compensator.rest",
    "compensator.motion",
    "compensator.motor",
    "compensator.reflection",
    "compensator.rivals",
    "compensator.lab.effects.effect",
    "compensator.lab.recordings",
)
BEGIN = """\
# Python interface

What a program of your own may import. `bench.client` talks to a running service and needs nothing but its address;
everything else works without a service. `compensator` takes arrays and returns numbers: it reads no file and knows no
bench.

"""


def pages() -> dict[str, str]:
    """Every page by its file: an index, and one for each public room."""
    rooms = {name: importlib.import_module(name) for name in PUBLIC}
    rows = [(f"[{code(name)}]({name}.md)", _first_sentence(room)) for name, room in rooms.items()]
    listed = "\n".join(["```{toctree}", ":hidden:", "", *rooms, "```"])
    found = {f"{FOLDER}/{name}.md": _room(name, room) for name, room in rooms.items()}
    found[f"{FOLDER}/index.md"] = f"{BEGIN}{table(('room', 'what it is for'), rows)}\n{listed}\n"
    return found


def _first_sentence(room: ModuleType) -> str:
    return (room.__doc__ or "").partition("\n\n")[0]


def _room(name: str, room: ModuleType) -> str:
    """A page: the room itself where it says what is public, else every module in it."""
    if hasattr(room, "__path__") and not hasattr(room, "__all__"):
        modules = [f"{name}.{one.name}" for one in pkgutil.iter_modules(room.__path__) if not one.ispkg]
        directives = "\n\n".join(f"## {code(one)}\n\n{_automodule(one)}" for one in modules)
        return f"# {code(name)}\n\n{_automodule(name)}\n\n{directives}\n"
    return f"# {code(name)}\n\n{_automodule(name, imported=hasattr(room, '__all__'))}\n"


def _automodule(name: str, imported: bool = False) -> str:
    options = [":members:", *[":imported-members:" for _ in range(imported)]]
    return "\n".join(["```{eval-rst}", f".. automodule:: {name}", *(f"   {one}" for one in options), "```"])
